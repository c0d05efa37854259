#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the stored numbers of the golden tests from the numpy reference of the method.

    make_golden.py FOLDER    FOLDER holds the Python package unisim_ref; needs numpy and scipy

The tests themselves need only the text files this script leaves beside it. Run it when the method
changes, and review the difference.
"""
import pathlib
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
HEADER = "# Written by make_golden.py; do not edit.\n"


def numbers(*parts):
    flat = np.concatenate([np.atleast_1d(np.asarray(p, float)).ravel() for p in parts])
    return " ".join("%.17g" % v for v in flat)


def pose(S3, T):
    """qx qy qz qw tx ty tz s"""
    w, x, y, z = S3.mat_to_quat(T.R)
    return numbers([x, y, z, w], T.t, T.s)


def write_lie(S3):
    """xi (7), exp(xi) as a pose (8), J_l(xi) row by row (49), J_l^-1(xi) (49)"""
    rng = np.random.default_rng(1)
    lines = []
    for angle in (0.0, 1e-9, 0.05, 0.2, 0.49, 0.72, 1.5, np.pi - 1e-7):
        for sigma in (-2.0, -0.3, 0.0, 0.1001, 3.0):
            axis = rng.normal(size=3)
            xi = np.concatenate([rng.normal(size=3), angle * axis / np.linalg.norm(axis), [sigma]])
            lines.append(" ".join([numbers(xi), pose(S3, S3.exp(xi)),
                                   numbers(S3.Jl(xi), S3.Jl_inv(xi))]))
    (HERE / "lie.txt").write_text(HEADER + "# " + write_lie.__doc__ + "\n" + "\n".join(lines) + "\n")


def random_pose(S3, rng, length, angle, sigma):
    axis = rng.normal(size=3)
    xi = np.concatenate([length * rng.normal(size=3), angle * axis / np.linalg.norm(axis),
                         [sigma * rng.normal()]])
    return S3.exp(xi)


def write_factors(S3, graph):
    """A B P Q (8 each), e = log((A P)^-1 (B Q)) (7), de/dA (49), de/dB (49); Q is 1 in every other line"""
    rng = np.random.default_rng(2)
    lines = []
    for k in range(24):
        A = random_pose(S3, rng, 2.0, rng.uniform(0, 3), 0.5)
        P = random_pose(S3, rng, 1.0, rng.uniform(0, 2), 0.3)
        Q = random_pose(S3, rng, 1.0, rng.uniform(0, 2), 0.3) if k % 2 else S3.Sim3.identity()
        size = 10.0 ** rng.uniform(-6, 0.3)
        B = A @ P @ random_pose(S3, rng, size, min(size, 2.5), size) @ Q.inv()
        g = graph.Graph(S3.stack([A, B]), 2)
        g.add_pose("pose", 0, 1, S3.stack([P]), S3.stack([Q]))
        g.freeze()
        e, Ja, Jb = g.pose_res_jac(g.X)
        lines.append(" ".join([pose(S3, T) for T in (A, B, P, Q)] + [numbers(e, Ja, Jb)]))
    (HERE / "factors.txt").write_text(HEADER + "# " + write_factors.__doc__ + "\n" +
                                      "\n".join(lines) + "\n")


FACTOR = {"e2v": "two_view", "br": "bridge", "lbr": "bridge", "tie": "tie", "ltie": "tie",
          "anch": "scale_anchor", "lanch": "scale_anchor", "sc": "scale", "lsc": "scale"}


def write_graph(name, what, S3, solve, g, start, kernels):
    """Graph in text: `node kind(T|S) fixed start(8) solved(8)`, `edge factor a b weight kernel delta
    payload` (one or two poses of 8, or the log ratio), `cost start solved`."""
    g.freeze()
    problem = solve.Problem(g, kernels=kernels)
    solved, _ = solve.lm(problem, start, max_iter=200, tol=1e-15, xtol=1e-12)
    lines = [HEADER + "# " + what]
    for k in range(len(start)):
        lines.append("node %s %d %s %s" % ("T" if k < g.n_kf else "S", k == 0, pose(S3, start[k]),
                                           pose(S3, solved[k])))
    kernel = lambda kind: "%s %.17g" % kernels.get(g.kinds[kind], ("huber", 1.0))
    for k in range(len(g.pa)):
        factor = FACTOR[g.kinds[g.pk[k]]]
        payload = pose(S3, g.P[k]) + (" " + pose(S3, g.Q[k]) if factor == "tie" else "")
        lines.append("edge %s %d %d %.17g %s %s" % (factor, g.pa[k], g.pb[k], g.pW[k, 0, 0],
                                                    kernel(g.pk[k]), payload))
    for k in range(len(g.sa)):
        lines.append("edge %s %d %d %.17g %s %.17g" % (FACTOR[g.kinds[g.sk[k]]], g.sa[k], g.sb[k],
                                                       g.sw[k], kernel(g.sk[k]), g.sc[k]))
    lines.append("cost %s" % numbers(problem.cost(start), problem.cost(solved)))
    (HERE / name).write_text("\n".join(lines) + "\n")
    print(name, len(start), "nodes", len(g.pa) + len(g.sa), "edges, cost", problem.cost(start), "->",
          problem.cost(solved))


def write_graphs(S3, solve, build, simulate):
    weights = dict(anch=1.0, sc=1.0)
    exact = simulate.Noise(mult=0.0, b0_2=0.0, tilt=0.0, pix=0.0, outl=0.0)

    P = simulate.predict(simulate.make_world(40, 3), 5, exact, wsize=8, loops=False)
    g = build.build(P, weights=weights)
    rng = np.random.default_rng(4)
    moved = g.X @ S3.exp(rng.uniform(-0.05, 0.05, (len(g.X), 7)))
    moved[0] = g.X[0]
    write_graph("graph_exact.txt", "exact measurements, every pose but the first moved", S3, solve, g,
                moved, {})

    P = simulate.predict(simulate.make_world(60, 3), 5, simulate.Noise(), wsize=10, gap=25)
    g = build.build(P, weights=weights)
    write_graph("graph_noisy.txt", "noisy measurements with loops, from the tracking chain", S3, solve,
                g, g.X, {})

    P = simulate.predict(simulate.make_world(100, 3), 5, simulate.Noise(), wsize=16, gap=30,
                         false_frac=0.3)
    g = build.build(P, weights=weights)
    write_graph("graph_false_loops.txt", "loops of which some are false, Geman-McClure on their poses",
                S3, solve, g, g.X, {"lbr": ("gm", 0.1), "ltie": ("gm", 0.1)})


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.path.insert(0, sys.argv[1])
    try:
        from unisim_ref import build, graph, sim3, simulate, solve
    except ImportError as error:
        sys.exit("make_golden.py: no usable package unisim_ref in %s: %s" % (sys.argv[1], error))
    write_lie(sim3)
    write_factors(sim3, graph)
    write_graphs(sim3, solve, build, simulate)


if __name__ == "__main__":
    main()
