#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes reference_run.txt: noisy predictions on a simulated walk, and the poses that the numpy
reference of the method finds for them in both presets and, as preset "window", with a sliding
window of two submaps (consistent).

    make_reference_run.py FOLDER    FOLDER holds the Python package unisim_ref; needs numpy and scipy

Run it when the method changes, and review the difference. Lines of the file:
    pair i  T_i_j  depth of i, depth of j          T: qx qy qz qw tx ty tz; depth: 7x7 values
    view window keyframe  T_submap_kf  depth
    pose preset keyframe  qx qy qz qw tx ty tz s   relative to keyframe 0
"""
import pathlib
import sys

import numpy as np

# An odd number of pixels: the median is one of them, whatever the convention for even counts.
KEYFRAMES, WINDOW, OVERLAP, WIDTH, HEIGHT = 30, 8, 2, 7, 7


def numbers(*parts):
    flat = np.concatenate([np.atleast_1d(np.asarray(p, float)).ravel() for p in parts])
    return " ".join("%.9g" % v for v in flat)


def depths(maps):
    return np.nan_to_num(np.asarray(maps, np.float32), nan=0.0)


def quaternion(S3, R):
    w, x, y, z = S3.mat_to_quat(R)
    return [x, y, z, w]


def main():
    sys.path.insert(0, sys.argv[1])
    from unisim_ref import bounded, build, sim3 as S3, simulate, solve
    simulate.raycast.__defaults__ = ((60.0, 46.0), WIDTH, HEIGHT, None, None)
    world = simulate.make_world(KEYFRAMES, 3, "scan")
    run = simulate.predict(world, 5, simulate.Noise(), wsize=WINDOW, phi=OVERLAP, loops=False)
    for item in run.pairs + run.subs:
        item.D = depths(item.D).astype(float)
        item.D[item.D == 0.0] = np.nan
    lines = []
    for pair in run.pairs:
        lines.append("pair %d %s" % (pair.i, numbers(quaternion(S3, pair.T.R), pair.T.t,
                                                     depths(pair.D))))
    for m, sub in enumerate(run.subs):
        for k, keyframe in enumerate(sub.idx):
            lines.append("view %d %d %s" % (m, keyframe, numbers(
                quaternion(S3, sub.T.R[k]), sub.T.t[k], depths(sub.D[k]))))
    presets = {"consistent": dict(weights={"anch": 1.0, "sc": 1.0}),
               "paper": dict(form="literal", d2="out")}
    for name, options in presets.items():
        X = None
        for _ in range(5):  # each call stops early along weak directions
            X, _, _ = build.run(run, loops=False, X0=X, **options)
        for k in range(KEYFRAMES):
            T = X[0].inv() @ X[k]
            lines.append("pose %s %d %s" % (name, k, numbers(quaternion(S3, T.R), T.t, T.s)))
    # To the optimum: the reference stops early, which is no property of the method.
    bounded.lm = lambda problem, **_: solve.lm(problem, max_iter=100, tol=1e-13, xtol=1e-13)
    X = bounded.Bounded(run, mode="skel", loop="late", win=2, use_loops=False,
                        W=dict(build.WEIGHTS, anch=1.0, sc=1.0)).run()
    for k in range(KEYFRAMES):
        T = X[0].inv() @ X[k]
        lines.append("pose window %d %s" % (k, numbers(quaternion(S3, T.R), T.t, T.s)))
    path = pathlib.Path(__file__).resolve().parent / "reference_run.txt"
    path.write_text("# Written by make_reference_run.py; do not edit.\n" + "\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
