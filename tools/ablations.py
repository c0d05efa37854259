#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The ablations of the paper's Tab. 4a and of S2 and S3 of its supplement, as one table.

    tools/ablations.py                                   # simulated predictions, 12 seeds
    tools/ablations.py --preset paper                    # the printed formulas and weights
    tools/ablations.py --recording RECORDING.rec --sequence SEQUENCE -- --stride 5

Simulated: unisim-bench window, 200 keyframes of the world `scan`, the full batch, mean of the ATE (m, Sim(3)) over the
seeds. Recorded: unisim-replay on predictions that --record has kept, whose overlap is that of the recording; S3 needs the
simulator. What stands after a lone -- goes to unisim-replay. The protocol stands above the table, the paper's
figures (7-Scenes, VGGT) beside ours. 0: printed; 2: bad usage; 3: a run failed.
"""
import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile

FACTORS = ["scale", "e2v", "anchor", "bridge", "tie", "v2s", "s2s"]
# Tab. 4a and S2, average over 7-Scenes: overlap 0, overlap 2.
PAPER = {"tracking only": (0.124, 0.124), "no loops": (0.061, 0.037), "scale": (0.048, 0.031), "e2v": (0.101, 0.021),
         "anchor": (0.083, 0.020), "bridge": (0.116, 0.063), "tie": (0.040, 0.027), "v2s": (0.124, 0.124),
         "s2s": (0.041, 0.030), "full": (0.032, 0.020)}
# S3: what is noisy, its sigma, the paper's average.
NOISE = [("scale", 0.15, 0.045), ("scale", 0.10, 0.041), ("scale", 0.05, 0.026), ("scale", 0.0, 0.020),
         ("depth", 0.3, 0.021), ("depth", 0.2, 0.021), ("depth", 0.1, 0.020), ("depth", 0.0, 0.020)]


class Failure(Exception):
    """One line for the user; a run failed."""


def parse_arguments(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--programs", help="folder of the programs (default: build/release/bin beside tools/)")
    parser.add_argument("--seeds", type=int, default=12, help="walks of each row (12)")
    parser.add_argument("--keyframes", type=int, default=200, help="of a walk (200)")
    parser.add_argument("--preset", choices=["consistent", "paper"], default="consistent")
    parser.add_argument("--recording", help="predictions instead of the simulator's")
    parser.add_argument("--sequence", help="what they were recorded from")
    parser.add_argument("--json", action="store_true", help="one JSON object instead of the table")
    own = arguments[:arguments.index("--")] if "--" in arguments else arguments
    options = parser.parse_args(own)
    options.replay = arguments[len(own) + 1:]
    if bool(options.recording) != bool(options.sequence):
        parser.error("--recording and --sequence go together")
    if options.seeds < 1:
        parser.error("--seeds: give 1 or more")
    if options.replay and not options.recording:
        parser.error("what stands after -- needs --recording")
    here = os.path.dirname(os.path.abspath(__file__))
    options.programs = options.programs or os.path.join(here, "..", "build", "release", "bin")
    return options


def run(command):
    try:
        done = subprocess.run(command, capture_output=True, text=True)
    except OSError as error:
        raise Failure(f"{command[0]}: {error.strerror}: build it, or give --programs") from error
    if done.returncode != 0:
        raise Failure(f"{' '.join(command)}: {done.stderr.strip() or done.returncode}")
    return done.stdout


def method(row):
    """Options that both programs know, but for loops and submaps."""
    return ["--disable", row] if row in FACTORS else []


def simulated(options, row, overlap, more=()):
    errors = []
    for seed in range(1, options.seeds + 1):
        command = [os.path.join(options.programs, "unisim-bench"), "window", "--world", "scan", "--keyframes",
                   str(options.keyframes), "--window-submaps", "0", "--batch", "off", "--preset", options.preset,
                   "--seed", str(seed), "--overlap", str(overlap), "--json", *method(row), *more]
        if row in ("no loops", "tracking only"):
            command += ["--loops", "off"]
        if row == "tracking only":
            command += ["--submaps", "off"]
        errors.append(json.loads(run(command))["ate_m"])
    return statistics.mean(errors)


def recorded(options, row, _overlap):
    """Tracking only: the bridges hold poses to windows, so without them and their scales the pairs are alone."""
    command = [os.path.join(options.programs, "unisim-replay"), options.sequence, "--predictor", "recorded",
               "--predictions", options.recording, "--quiet", "--no-report", "--batch", *options.replay]
    command += ["--disable", "v2s", "--no-loop"] if row == "tracking only" else method(row)
    command += ["--no-loop"] if row == "no loops" else []
    with tempfile.TemporaryDirectory() as folder:
        run([*command, "--out", os.path.join(folder, "out")])
        with open(os.path.join(folder, "out", "summary.json"), encoding="utf-8") as file:
            summary = json.load(file)
    if summary["ate_rmse_m"] is None:
        raise Failure(f"{options.sequence}: no score: {summary['score_problem'] or 'no ground truth'}")
    return summary["ate_rmse_m"]


def measure(options):
    ate, overlaps = (recorded, [None]) if options.recording else (simulated, [0, 2])
    rows = [{"row": row, "overlap": overlap, "ate_m": ate(options, row, overlap),
             "paper_m": None if overlap is None else paper[overlap // 2]}
            for row, paper in PAPER.items() for overlap in overlaps]
    noise = []
    for what, sigma, paper in [] if options.recording else NOISE:
        more = [f"--{what}-noise", str(sigma)] + (["--holes", "0.1"] if what == "depth" and sigma > 0 else [])
        noise.append({"noise": what, "sigma": sigma, "ate_m": simulated(options, "full", 2, more), "paper_m": paper})
    return {"protocol": protocol(options), "ablations": rows, "noise": noise}


def protocol(options):
    if options.recording:
        return {"predictions": options.recording, "sequence": options.sequence, "options": " ".join(options.replay),
                "alignment": "sim3", "session": "batch"}
    return {"predictions": "simulated, world scan", "keyframes": options.keyframes, "seeds": options.seeds,
            "alignment": "sim3", "session": "batch", "preset": options.preset}


def table(result):
    lines = [", ".join(f"{name} {value}" for name, value in result["protocol"].items()), ""]
    by_row = {}
    for entry in result["ablations"]:
        by_row.setdefault(entry["row"], []).append(entry)
    simulated_run = len(by_row["full"]) > 1
    lines += (["| ATE m, without | overlap 0 | paper | overlap 2 | paper |", "|---|---|---|---|---|"] if simulated_run
              else ["| without | ATE m |", "|---|---|"])
    for row, entries in by_row.items():
        digits = 3 if simulated_run else 4  # one recording repeats to the last digit
        figures = [f"{e['ate_m']:.{digits}f}" + (f" | {e['paper_m']:.3f}" if e["paper_m"] is not None else "")
                   for e in entries]
        lines.append(f"| {row} | " + " | ".join(figures) + " |")
    if result["noise"]:
        lines += ["", "| more noise of | sigma | ATE m | paper |", "|---|---|---|---|"]
    for entry in result["noise"]:
        lines.append(f"| {entry['noise']} | {entry['sigma']} | {entry['ate_m']:.3f} | {entry['paper_m']:.3f} |")
    return "\n".join(lines)


def main():
    options = parse_arguments(sys.argv[1:])
    try:
        result = measure(options)
    except Failure as failure:
        print(f"ablations.py: {failure}", file=sys.stderr)
        return 3
    print(json.dumps(result) if options.json else table(result))
    return 0


if __name__ == "__main__":
    sys.exit(main())
