#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Holds the camera's pose as a robot would: live poses, corrections, state and unit, from LCM alone.

Needs the Python module lcm and what lcm-gen makes of the messages:
    lcm-gen --python --ppath DIR PREFIX/share/unisim/lcm/*.lcm
    PYTHONPATH=DIR pose_consumer.py [POSES [URL]]
Prints one line for each message; ends after so many poses.
"""
import sys

import lcm
import unisim


def multiply(a, b):
    """Quaternions w x y z."""
    return (
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    )


def rotate(q, p):
    conjugate = (q[0], -q[1], -q[2], -q[3])
    return multiply(multiply(q, (0.0, *p)), conjugate)[1:]


class Robot:
    def __init__(self):
        self.poses = 0
        self.utime = 0
        self.pos = (0.0, 0.0, 0.0)
        self.orientation = (1.0, 0.0, 0.0, 0.0)
        self.map_revision = 0
        self.segment = 0  # poses of different segments have nothing in common

    def say(self, why):
        print(f"{why} utime {self.utime} revision {self.map_revision} pos "
              + " ".join(f"{value:.9f}" for value in self.pos), flush=True)

    def on_pose(self, _channel, data):
        pose = unisim.pose_t.decode(data)  # raises ValueError for a message of another type
        self.utime, self.pos, self.orientation = pose.utime, pose.pos, pose.orientation
        self.poses += 1
        self.say("pose")

    def on_correction(self, _channel, data):
        jump = unisim.correction_t.decode(data)
        self.map_revision = jump.map_revision
        # A pose that is newer is in the corrected map already; another segment has its own frame.
        if self.poses == 0 or self.utime > jump.utime or jump.segment != self.segment:
            return
        turned = rotate(jump.jump_orientation, self.pos)
        self.pos = tuple(jump.jump_scale * t + j for t, j in zip(turned, jump.jump_pos))
        self.orientation = multiply(jump.jump_orientation, self.orientation)
        self.say("corrected")

    def on_status(self, _channel, data):
        status = unisim.status_t.decode(data)
        if status.segment >= 0:
            self.segment = status.segment
        metric = status.unit == unisim.status_t.UNIT_METRIC
        print(f"status state {status.state} confidence {status.confidence} unit "
              f"{'metres' if metric else 'of the map'} segment {status.segment} "
              f"revision {status.map_revision}", flush=True)


def main():
    wanted = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    network = lcm.LCM(*sys.argv[2:3])
    robot = Robot()
    for channel, handler in (("UNISIM_POSE", robot.on_pose),
                             ("UNISIM_CORRECTION", robot.on_correction),
                             ("UNISIM_STATUS", robot.on_status)):
        network.subscribe(channel, handler).set_queue_capacity(0)
    print("listening", flush=True)
    while robot.poses < wanted:
        network.handle()
    print(f"done poses {robot.poses} foreign 0", flush=True)


if __name__ == "__main__":
    main()
