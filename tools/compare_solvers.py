#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Time unisim-bench solver side by side with other pose-graph solvers.

    tools/compare_solvers.py --peers DIR GRAPH.usg GRAPH.g2o ...
    tools/compare_solvers.py --peers DIR --keyframes 200,1000,5000
    tools/compare_solvers.py --peers DIR --keyframes 1200 --updates-from 1000

DIR holds the built programs of the peers harness (run_ceres, run_g2o, run_yardstick, gen_graph);
the ones that are missing are left out, without --peers our solver is shown alone. A program takes a
graph file and prints one JSON line: solver, config, iterations, cost0, cost, rss_before_kb,
rss_peak_kb, allocs, trace [[CPU ms, cost], ...].

t6 is the CPU time from the start of the optimisation, ordering and analysis included, until the
cost is within 1e-6 (relative) of the lowest cost any solver reached on the graph.

With --updates-from N, graphs in .usg are also fed submap by submap, as on a robot, and updates from N
keyframes on are timed: ours, and iSAM2 of GTSAM where DIR holds run_isam2_wheel.py and the Python of
--python can import gtsam. That program takes a graph and N, and prints median_ms, max_ms and cost.
"""
import argparse
import json
import os
import platform
import statistics
import subprocess
import sys
import tempfile

OURS = "unisim-bench"
USG_RUNS = [
    ("run_yardstick", []),
    ("run_ceres", ["analytic", "suite"]),
    ("run_g2o", ["custom", "cholmod", "lm"]),
    ("run_g2o", ["custom", "csparse", "lm"]),
    ("run_g2o", ["custom", "cholmod", "gn", "12"]),
    ("run_g2o", ["custom", "csparse", "gn", "12"]),
]
G2O_RUNS = [
    ("run_ceres", ["auto", "suite", "amd", "40"]),
    ("run_g2o", ["custom", "cholmod", "lm"]),
    ("run_g2o", ["custom", "cholmod", "gn", "20"]),
    ("run_g2o", ["custom", "csparse", "gn", "20"]),
]
ISAM2 = "run_isam2_wheel.py"


class Failure(Exception):
    """One line for the user and an exit code."""

    def __init__(self, code, text):
        super().__init__(text)
        self.code = code


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("graphs", nargs="*", metavar="GRAPH", help=".usg or .g2o files")
    parser.add_argument("--bench", help="unisim-bench (default: build/release/bin beside tools/)")
    parser.add_argument("--peers", help="folder with the built peers")
    parser.add_argument("--keyframes", help="also graphs of gen_graph with these numbers, as 200,1000")
    parser.add_argument("--reps", type=int, default=5, help="repetitions, interleaved (5)")
    parser.add_argument("--timeout", type=float, default=300, help="seconds for one run (300)")
    parser.add_argument("--updates-from", type=int, metavar="N", help="also time live updates from N keyframes on")
    parser.add_argument("--python", default=sys.executable, help="Python that may have gtsam (this one)")
    parser.add_argument("--json", metavar="FILE", help="append every result line to FILE")
    arguments = parser.parse_args()
    if arguments.reps < 1:
        parser.error("--reps: at least 1")
    if not arguments.graphs and not arguments.keyframes:
        parser.error("give graph files, or --peers DIR --keyframes N,N")
    return arguments


def bench_program(arguments):
    if arguments.bench:
        path = arguments.bench
    else:
        root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
        path = os.path.join(root, "build", "release", "bin", OURS)
    if not os.access(path, os.X_OK):
        raise Failure(3, f"{path}: no such program: build it or give --bench")
    return path


def generate_graphs(arguments, folder):
    if not arguments.keyframes:
        return []
    generator = os.path.join(arguments.peers or "", "gen_graph")
    if not arguments.peers or not os.access(generator, os.X_OK):
        raise Failure(3, "--keyframes needs gen_graph in the folder of --peers")
    paths = []
    for keyframes in arguments.keyframes.split(","):
        path = os.path.join(folder, f"k{keyframes}.usg")
        command = [generator, "--keyframes", keyframes, "--out", path]
        if subprocess.run(command, stderr=subprocess.DEVNULL).returncode != 0:
            raise Failure(3, f"--keyframes {keyframes}: gen_graph failed")
        paths.append(path)
    return paths


def commands_for(graph, arguments, bench):
    commands = [[bench, "solver", graph, "--json"]]
    for program, options in G2O_RUNS if graph.endswith(".g2o") else USG_RUNS:
        path = os.path.join(arguments.peers, program) if arguments.peers else ""
        if os.access(path, os.X_OK):
            commands.append([path, graph] + options)
    return commands


def run_once(command, timeout):
    """One process; its result, or None with a line on stderr."""
    environment = dict(os.environ, OPENBLAS_NUM_THREADS="1", OMP_NUM_THREADS="1")
    name = " ".join(os.path.basename(part) for part in command)
    try:
        done = subprocess.run(command, capture_output=True, text=True, env=environment, timeout=timeout)
    except subprocess.TimeoutExpired:
        print(f"compare_solvers: {name}: no result in {timeout:g} s", file=sys.stderr)
        return None
    lines = [line for line in done.stdout.splitlines() if line.startswith("{")]
    if done.returncode != 0 or not lines:
        reason = done.stderr.strip().splitlines()
        print(f"compare_solvers: {name}: exit {done.returncode}: {reason[-1] if reason else 'no result'}",
              file=sys.stderr)
        return None
    return json.loads(lines[-1])


def measure(graph, arguments, bench):
    """Results by (solver, config), in the order of the first repetition."""
    runs = {}
    for _ in range(arguments.reps):
        for command in commands_for(graph, arguments, bench):
            result = run_once(command, arguments.timeout)
            if result is None:
                continue
            runs.setdefault((result["solver"], result["config"]), []).append(result)
            if arguments.json:
                with open(arguments.json, "a", encoding="utf-8") as file:
                    file.write(json.dumps(result) + "\n")
    return runs


def time_to(trace, cost):
    return next((ms for ms, reached in trace if reached <= cost), None)


def per_iteration(result):
    trace = result["trace"]
    return (trace[-1][0] - trace[0][0]) / (len(trace) - 1) if len(trace) > 1 else 0.0


def summary(results, best_cost):
    reached = [time_to(result["trace"], best_cost * (1 + 1e-6)) for result in results]
    known = [ms for ms in reached if ms is not None]
    return {
        "t6": statistics.median(known) if len(known) == len(reached) else None,
        "t6_min": min(known) if known else None,
        "iteration_ms": statistics.median(per_iteration(result) for result in results),
        "solve_ms": statistics.median(result["solve_ms"] for result in results),
        "iterations": results[0]["iterations"],
        "gap": min(result["cost"] for result in results) / best_cost - 1,
        "rss_mb": (results[0]["rss_peak_kb"] - results[0]["rss_before_kb"]) / 1024,
        "allocs": results[0]["allocs"],
    }


def text(value, form):
    return format(value, form) if value is not None else "-"


def ratio(value, ours):
    return value / ours if value is not None and ours else None


def print_table(graph, runs):
    best_cost = min(result["cost"] for results in runs.values() for result in results)
    first = next(iter(runs.values()))[0]
    print(f"\n{os.path.basename(graph)}: {first['nodes']} nodes, {first['edges']} edges, "
          f"cost {first['cost0']:.9g} -> {best_cost:.9g}")
    print(f"{'solver':34s} {'t6 ms':>9s} {'min':>9s} {'ratio':>7s} {'ms/iter':>9s} {'ratio':>7s} "
          f"{'iters':>5s} {'rel. gap':>9s} {'MB':>7s} {'allocs':>8s}")
    rows = {key: summary(results, best_cost) for key, results in runs.items()}
    ours = next((row for key, row in rows.items() if key[0] == "unisim"), {"t6": None, "iteration_ms": None})
    for (solver, config), row in sorted(rows.items(), key=lambda item: item[1]["t6"] or float("inf")):
        print(f"{solver + ' ' + config:34s} {text(row['t6'], '9.3f'):>9s} {text(row['t6_min'], '9.3f'):>9s} "
              f"{text(ratio(row['t6'], ours['t6']), '7.2f'):>7s} {row['iteration_ms']:9.3f} "
              f"{text(ratio(row['iteration_ms'], ours['iteration_ms']), '7.2f'):>7s} {row['iterations']:5d} "
              f"{row['gap']:9.1e} {row['rss_mb']:7.1f} {row['allocs']:8d}")


def print_split(runs):
    print(f"{'split, ms per run (first repetition)':34s}")
    for (solver, config), results in runs.items():
        split = results[0].get("split_ms", {})
        parts = "  ".join(f"{phase} {ms:.3f}" for phase, ms in split.items())
        print(f"  {solver + ' ' + config:32s} {parts}")


def update_commands(graph, arguments, bench):
    """Commands by the name of their row; iSAM2 takes one Gauss-Newton step per update."""
    start = str(arguments.updates_from)
    ours = [bench, "updates", graph, "--from", start, "--json", "--iterations"]
    commands = {"unisim, 1 iteration": ours + ["1"], "unisim, 2 iterations": ours + ["2"]}
    script = os.path.join(arguments.peers or "", ISAM2)
    has_gtsam = [arguments.python, "-c", "import gtsam"]
    if arguments.peers and os.path.exists(script) and \
            subprocess.run(has_gtsam, stderr=subprocess.DEVNULL).returncode == 0:
        commands["iSAM2 of GTSAM"] = [arguments.python, script, graph, start]
    return commands


def update_times(result):
    """Median of the updates and the longest one; ours tells updates that close a loop apart."""
    if "median_ms" in result:
        return result["median_ms"], result["max_ms"]
    return result["update_ms"]["p50"], max(result["update_ms"]["max"], result["loop_update_ms"]["max"])


def print_updates(graph, arguments, bench):
    commands = update_commands(graph, arguments, bench)
    runs = {name: [] for name in commands}
    for _ in range(arguments.reps):
        for name, command in commands.items():
            result = run_once(command, arguments.timeout)
            if result is not None:
                runs[name].append(result)
    if not any(update_times(result)[0] for results in runs.values() for result in results):
        raise Failure(3, f"{graph}: no updates from {arguments.updates_from} keyframes on: give less to --updates-from")
    runs = {name: results for name, results in runs.items() if results}
    best_cost = min(result["cost"] for results in runs.values() for result in results)
    print(f"{'updates from ' + str(arguments.updates_from) + ' keyframes on':34s} {'median ms':>9s} {'max':>9s} "
          f"{'ratio':>7s} {'rel. gap':>9s}")
    ours = None
    for name, results in runs.items():
        medians, longest = zip(*(update_times(result) for result in results))
        ours = ours or statistics.median(medians)
        print(f"  {name:32s} {statistics.median(medians):9.3f} {statistics.median(longest):9.3f} "
              f"{text(ratio(statistics.median(medians), ours), '7.2f'):>7s} {results[0]['cost'] / best_cost - 1:9.1e}")


def processor():
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            for line in file:
                if line.startswith("model name"):
                    return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()


def print_protocol(arguments, bench):
    load = f", load {os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else ""
    print(f"machine: {processor()}, {os.cpu_count()} cores{load}, {platform.system()} {platform.release()}")
    print(f"protocol: CPU time of one process per run, one thread, {arguments.reps} repetitions interleaved "
          "over the solvers; t6 and ms/iter are medians, min the least t6; ratios are to ours")
    print("t6: CPU ms until the cost is within 1e-6 (relative) of the lowest any solver reached, ordering and "
          "analysis included, building the problem not")
    print(f"ours: {bench}; peers: {arguments.peers or 'none given'}")


def main():
    arguments = parse_arguments()
    bench = bench_program(arguments)
    print_protocol(arguments, bench)
    with tempfile.TemporaryDirectory() as folder:
        for graph in generate_graphs(arguments, folder) + arguments.graphs:
            if not os.path.exists(graph):
                raise Failure(3, f"{graph}: no such file")
            runs = measure(graph, arguments, bench)
            if not runs:
                raise Failure(1, f"{graph}: no solver gave a result")
            print_table(graph, runs)
            print_split(runs)
            if arguments.updates_from is not None and graph.endswith(".usg"):
                print_updates(graph, arguments, bench)


if __name__ == "__main__":
    try:
        main()
    except Failure as failure:
        print(f"compare_solvers: {failure}", file=sys.stderr)
        sys.exit(failure.code)
