#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Reads an LCM event log with the Python module lcm, decodes every message with the classes that lcm-gen made, encodes it
anew and writes it to another log. Usage: copy_log.py IN OUT. Says for each channel the number of its messages."""
import collections
import sys

import lcm
import unisim

TYPES = {
    "UNISIM_POSE": unisim.pose_t,
    "UNISIM_KEYFRAME": unisim.keyframe_t,
    "UNISIM_CORRECTION": unisim.correction_t,
    "UNISIM_TRAJECTORY": unisim.trajectory_t,
    "UNISIM_STATUS": unisim.status_t,
    "UNISIM_POINTS": unisim.points_t,
    "UNISIM_IMAGE": unisim.image_t,
}


def main():
    counts = collections.Counter()
    out = lcm.EventLog(sys.argv[2], "w", overwrite=True)
    for event in lcm.EventLog(sys.argv[1], "r"):
        message = TYPES[event.channel].decode(event.data)
        out.write_event(event.timestamp, event.channel, message.encode())
        counts[event.channel] += 1
    out.close()
    print(" ".join(f"{channel} {count}" for channel, count in sorted(counts.items())))


if __name__ == "__main__":
    main()
