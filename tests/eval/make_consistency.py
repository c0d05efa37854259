#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Prints the figures that consistency_test.cpp expects: the same run, judged with numpy."""
import numpy as np


def rotation(axis, angle):
    x, y, z = np.array(axis) / np.linalg.norm(axis)
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def nearest_rotation(M):
    U, S, Vt = np.linalg.svd(M)
    d = np.array([1, 1, np.sign(np.linalg.det(U) * np.linalg.det(Vt))])
    return U @ np.diag(d) @ Vt, S @ d


def judge(rows):
    """Of one segment: errors, and ratios of position and rotation where there is a sigma."""
    X, Y = np.array([r["p"] for r in rows]), np.array([r["true_p"] for r in rows])
    x, y = X - X.mean(0), Y - Y.mean(0)
    R, trace = nearest_rotation(y.T @ x)
    s = trace / (x ** 2).sum()
    error = np.linalg.norm(s * x @ R.T - y, axis=1)
    turns = [r["true_R"].T @ R @ r["R"] for r in rows]
    mean, _ = nearest_rotation(sum(turns))
    angle = [np.arccos(np.clip((np.trace(t @ mean.T) - 1) / 2, -1, 1)) for t in turns]
    known = [k for k, r in enumerate(rows) if r["sigma"] is not None]
    return (error, [error[k] / (s * rows[k]["sigma"]) for k in known],
            [angle[k] / (0.5 * rows[k]["sigma"]) for k in known])


def run():
    """A helix of 40 poses in two segments, drawn in another frame and size; one pose is far off."""
    turn, rows = rotation([1, 2, 3], 2.0), []
    for k in range(40):
        a = 0.1 * k
        row = {"true_R": rotation([0.1, 1, 0.2], a), "true_p": np.array([np.cos(a), 0.05 * a, np.sin(a)])}
        wrong = 0.01 * np.array([np.sin(3 * k), np.cos(5 * k), np.sin(7 * k)]) * (60 if k == 26 else 1)
        scale = 0.5 if k < 12 else 2.0
        row["p"] = scale * turn @ (row["true_p"] + wrong) + np.array([1, -2, 3])
        row["R"] = turn @ row["true_R"] @ rotation([1, 0, 1], 0.02) @ rotation([0, 1, 0], 0.003 * np.sin(11 * k))
        row["sigma"] = None if k == 5 else scale * (0.004 + 0.0002 * k)
        row["good"] = k != 3
        row["confidence"] = 2 if k % 4 == 0 else 3
        rows.append(row)
    return rows


def main():
    rows = run()
    position, turned, far, errors = [], [], 0, {2: [], 3: []}
    for part in (rows[:12], rows[12:]):
        error, ratios, angles = judge(part)
        position += ratios
        turned += angles
        for row, e in zip(part, error):
            errors[row["confidence"]].append(e)
            far += row["good"] and e > 10 * np.median(error)
    for name, values in (("position", position), ("rotation", turned)):
        v = np.array(values)
        print(name, len(v), *(f"{x:.9f}" for x in ((v > 3).mean(), np.median(v), np.percentile(v, 95), v.max())))
    print("far off", far, *(f"{np.median(e):.9f}" for e in errors.values()))


if __name__ == "__main__":
    main()
