#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the file that python_test.cpp reads: write_predictions.py EXPORT_FOLDER FILE"""

import sys

sys.path.insert(0, sys.argv[1])

import numpy as np  # noqa: E402
from unisim_record import RecordError, RecordWriter  # noqa: E402

DEPTH = np.arange(15, dtype=np.float32).reshape(3, 5) / np.float32(7) + np.float32(1)
DEPTH[0, 1] = np.nan


def pose(angle, x):
    """A turn about y by `angle` and a step of x along x."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, 0, s, x], [0, 1, 0, 0], [-s, 0, c, 0], [0, 0, 0, 1.0]])


def must_refuse(call, *arguments):
    try:
        call(*arguments)
    except RecordError:
        return
    raise SystemExit(f"{call.__name__} took a bad prediction")


with RecordWriter(sys.argv[2], "séquence", "test-network", (320, 240)) as record:
    for keyframe_id in range(4):
        record.keyframe(keyframe_id, 10 * keyframe_id, 1000 * keyframe_id)
    record.pair(0, 1, pose(0.25, 0.5), DEPTH, 2 * DEPTH, confidence_j=np.full_like(DEPTH, 3),
                focal_px=300.5, center_sigma=0.125)
    record.reject_pair(1, 2, "the network saw a wall")
    record.window([0, 1, 2], [pose(3.1, 1.0), pose(-3.1, 2.0)], [DEPTH, DEPTH + 1],
                  solved_ids=[0, 2], token=77, at_keyframe=3, unit=(2.5, 0.125, 0.0625))
    must_refuse(record.pair, 2, 3, np.full((4, 4), np.nan), DEPTH, DEPTH)
    must_refuse(record.pair, 2, 3, 2 * np.eye(4), DEPTH, DEPTH)
    must_refuse(record.keyframe, 9, 90)
    large = np.linspace(1, 2, 300 * 200, dtype=np.float32).reshape(200, 300)
    record.pair(2, 3, np.eye(4), large, large)
