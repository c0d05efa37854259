#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Run unisim-replay on recordings and on worse versions of them, and print one table.

    tools/benchmark.py RECORDING... --out DIR
    tools/benchmark.py --synth room,corridor --conditions original,half,flicker --out DIR
    tools/benchmark.py RECORDING --out DIR --compare OLD/table.json
    tools/benchmark.py --suite FILE --out DIR

Recordings are what unisim-replay takes, videos too. Images of the conditions (--list names them) are made once and
kept under DIR/recordings (--work). DIR gets table.md and table.json, the protocol in both. Ground truth: a file in
TUM format, --ground-truth or groundtruth.txt in the recording, or the pose files of 7-Scenes; without one there are no
errors, only coverage. A row that fails says why in one line and the others go on. Each line of a suite is a command
line of this program; all rows come into one table. What follows a lone -- goes to unisim-replay as it stands.
Needs numpy and OpenCV for Python.
"""
import argparse
import copy
import csv
import json
import os
import platform
import shlex
import statistics
import sys
from pathlib import Path

try:
    from benchmark_conditions import CONDITIONS
    from benchmark_recording import Failure, Recording, call, last_line, path_length, read_poses
    from benchmark_table import comparison_text, table_text
except ImportError as problem:
    sys.exit(f"benchmark: {problem}; install python3-numpy and python3-opencv")

TOOLS = Path(__file__).resolve().parent


def names_or_file(text):
    """Names with commas between them, or a file with one a line."""
    path = Path(text)
    parts = path.read_text().split() if path.is_file() else text.split(",")
    return [part for part in parts if part]


def parser():
    made = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = made.add_argument
    add("recordings", nargs="*", metavar="RECORDING")
    add("--data", metavar="DIR", help="every folder in DIR is a recording")
    add("--synth", metavar="SCENES", help="render these scenes of unisim-synth: room,corridor,desk")
    add("--synth-frames", type=int, default=300, metavar="N", help="frames of each (300)")
    add("--synth-size", default="640x480", metavar="WxH")
    add("--synth-options", default="--loops 1 --noise --blur", metavar="TEXT", help="others (--loops 1 --noise --blur)")
    add("--suite", metavar="FILE", help="command lines of this program, one a line: one table; $NAMES are replaced")
    add("--name", help="of the one recording, in the table (its folder's)")
    add("--conditions", metavar="NAMES|FILE", help="some of the conditions, with commas or one a line (all)")
    add("--list", action="store_true", help="print the conditions, end")
    add("--offsets", default="0", metavar="N,N", help="first frames; one run for each, the table has medians (0)")
    add("--format", default="auto", help="of the recordings, as unisim-replay has it")
    add("--from", type=int, default=0, dest="first", metavar="A")
    add("--to", type=int, default=-1, dest="last", metavar="B", help="frames [A, B) of each recording")
    add("--ground-truth", metavar="FILE", help="poses in TUM format, of one recording")
    add("--true-focal", type=float, metavar="F", help="pixels (default: camera.toml, else 0.85 of the width)")
    add("--predictor", default="geometric")
    add("--out", default="benchmark", metavar="DIR", help="results (benchmark/)")
    add("--work", metavar="DIR", help="images that are made (OUT/recordings)")
    add("--store", metavar="FILE", help="write table.json here too")
    add("--compare", metavar="FILE", help="an earlier table.json: ratios, and what got worse")
    add("--worse", type=float, default=0.1, metavar="SHARE", help="that counts as worse (0.1)")
    add("--bin", default=str(TOOLS.parent / "build/release/bin"), metavar="DIR", help="the programs")
    return made


def parse_arguments(argv, base=None):
    """What is not said is as in base; what follows -- is added to what followed it there."""
    own, extra = (argv[:argv.index("--")], argv[argv.index("--") + 1:]) if "--" in argv else (argv, [])
    arguments = parser().parse_args(own, copy.copy(base) if base else None)
    arguments.extra = (base.extra if base else []) + extra
    return arguments


def jobs_of(arguments):
    """One for each line of a suite; without one the command line itself."""
    if not arguments.suite:
        return [checked(arguments)]
    try:
        text = Path(arguments.suite).read_text()
    except (OSError, UnicodeDecodeError):
        raise Failure(3, f"--suite: {arguments.suite} cannot be read") from None
    lines = (shlex.split(os.path.expandvars(line), comments=True) for line in text.splitlines())
    jobs = [checked(parse_arguments(words, arguments)) for words in lines if words]
    if not jobs:
        raise Failure(3, f"--suite: {arguments.suite} has no line")
    return jobs


def checked(arguments):
    arguments.wanted = names_or_file(arguments.conditions) if arguments.conditions else list(CONDITIONS)
    for name in arguments.wanted:
        if name not in CONDITIONS:
            raise Failure(2, f"--conditions: {name} is not known; --list names them")
    try:
        arguments.first_frames = [int(text) for text in arguments.offsets.split(",")]
    except ValueError:
        arguments.first_frames = [-1]
    if min(arguments.first_frames) < 0:
        raise Failure(2, f"--offsets is {arguments.offsets}, must be frame numbers, as 0,1,2")
    arguments.paths = [Path(text) for text in arguments.recordings]
    if arguments.data:
        if not Path(arguments.data).is_dir():
            raise Failure(3, f"--data: {arguments.data} is no folder")
        arguments.paths += sorted(path for path in Path(arguments.data).iterdir() if path.is_dir())
    for path in arguments.paths:
        if not path.exists():
            raise Failure(3, f"{path}: no such recording")
    arguments.scenes = names_or_file(arguments.synth) if arguments.synth else []
    count = len(arguments.paths) + len(arguments.scenes)
    if count == 0:
        raise Failure(2, "give recordings, --data DIR, --synth SCENES or --suite FILE")
    if count != 1 and (arguments.ground_truth or arguments.name):
        raise Failure(2, "--ground-truth and --name are those of one recording")
    return arguments


def figures(truth, out, focal_true):
    """What one run gave."""
    summary = json.loads((out / "summary.json").read_text())
    row = {"coverage": summary["coverage"], "segments": summary["segments"], "ate_all_m": summary["ate_rmse_m"],
           "focal_px": summary["focal_px"], "fps": summary["fps"],
           "live_p95_ms": summary["timing_ms"]["track_total"]["p95"],
           "memory_mb": summary["memory"]["process_peak_bytes"] / 1e6}
    if focal_true and row["focal_px"]:
        row["focal_error"] = row["focal_px"] / focal_true - 1
    longest = max(summary["segment_scores"], key=lambda segment: segment["keyframes"], default=None)
    if longest is None or longest["ate_rmse_m"] is None:
        return row
    row["ate_m"] = longest["ate_rmse_m"]
    with open(out / "keyframes.csv") as file:
        times = {int(line["id"]): float(line["timestamp"]) for line in csv.DictReader(file)}
    length = path_length(truth, times[longest["first"]], times[longest["last"]])
    if length > 0:
        row["ate_share"] = row["ate_m"] / length
    return row


def belief(arguments, truth, out):
    """How far the run's own standard deviations can be believed."""
    result = call(arguments, "unisim-eval", "consistency", truth, out, "--json")
    if result.returncode != 0:
        return {}
    found = json.loads(result.stdout)
    row = {"good_far_off": found["good_far_off"]}
    if found["position"]["poses"]:
        row |= {"beyond_3_sigma": found["position"]["beyond_3_sigma"], "sigma_ratio": found["position"]["median"]}
    return row


def replay_options(arguments, recording, condition, offset):
    """The sequence and its frames; the file of its ground truth, None without one; the poses in that."""
    if condition.make is None:
        last = ["--to", arguments.last] if arguments.last >= 0 else []
        file = recording.own_truth() if len(recording.truth) else None
        given = ["--ground-truth", file] if file else []
        return [recording.path, "--format", arguments.format, "--from", arguments.first + offset, *last,
                *given], file, recording.truth
    folder = recording.degraded(condition)
    truth = folder / "groundtruth.txt"
    options = [folder, "--format", "tum", "--from", offset]
    return (options, truth, read_poses(truth)) if truth.is_file() else (options, None, recording.truth[:0])


def measure(arguments, recording, name, out):
    """One row: medians over the first frames."""
    condition = CONDITIONS[name]
    if condition.needs_focal and not recording.focal_known:
        raise Failure(2, "the focal length is not known; give --true-focal")
    focal = recording.focal * condition.focal
    runs, problem = [], ""
    for offset in arguments.first_frames:
        target = out / "runs" / f"{recording.name}-{name}-{offset}"
        options, file, truth = replay_options(arguments, recording, condition, offset)
        result = call(arguments, "unisim-replay", *options, "--predictor", arguments.predictor, "--out", target,
                      "--force", "--quiet", "--no-report", *condition.given(focal), *arguments.extra)
        if result.returncode == 0:
            runs.append(figures(truth, target, focal if recording.focal_known else 0))
            runs[-1] |= belief(arguments, file, target) if file else {}
        else:
            problem = last_line(result)
    row = {"runs": len(runs)}
    for key in sorted({key for run in runs for key in run}):
        values = [run[key] for run in runs if run.get(key) is not None]
        if values:
            row[key] = statistics.median(values)
    errors = [run["ate_m"] for run in runs if "ate_m" in run]
    if len(errors) > 1:
        row["ate_worst_m"] = max(errors)
    for key in ("beyond_3_sigma", "good_far_off"):  # no run may hide behind others
        values = [run[key] for run in runs if key in run]
        if values:
            row[key] = max(values)
    if problem:
        row["problem"] = f"{len(arguments.first_frames) - len(runs)} of {len(arguments.first_frames)} runs: {problem}"
    return row


def render(arguments, scene, work):
    """A synthetic recording; one that is there from the same options is taken again."""
    folder = work / f"synth-{arguments.name or scene}"
    options = ["--scene", scene, "--frames", str(arguments.synth_frames), "--size", arguments.synth_size,
               *shlex.split(arguments.synth_options)]
    mark = Path(f"{folder}.json")
    if mark.is_file() and json.loads(mark.read_text()) == options and (folder / "rgb.txt").is_file():
        return folder
    mark.unlink(missing_ok=True)
    result = call(arguments, "unisim-synth", folder, *options, "--force")
    if result.returncode != 0:
        raise Failure(result.returncode, last_line(result))
    mark.write_text(json.dumps(options))
    return folder


def protocol(arguments, jobs):
    version = call(arguments, "unisim-replay", "--version").stdout.strip()
    cpu = next((text.split(":", 1)[1].strip() for text in Path("/proc/cpuinfo").read_text().splitlines()
                if text.startswith("model name")), platform.processor()) if Path("/proc/cpuinfo").is_file() else ""

    def of_jobs(text):
        return "; ".join(dict.fromkeys(text(job) for job in jobs))

    return {"program": version, "predictor": of_jobs(lambda job: " ".join([job.predictor, *job.extra])),
            "frames": of_jobs(lambda job: f"[{job.first}, {job.last if job.last >= 0 else 'end'})"),
            "first frames": of_jobs(lambda job: job.offsets) + "; figures are medians of these runs",
            "alignment": "Sim(3) on keyframes, the longest segment and all together",
            "ground truth": of_jobs(lambda job: job.ground_truth or "of each recording") + ", nearest in time",
            "machine": f"{cpu}, {os.cpu_count()} cores, {platform.system()} {platform.machine()}"}


def read_table(path):
    try:
        table = json.loads(Path(path).read_text())
        if table["schema"] == 1 and isinstance(table["rows"], list):
            return table
    except (OSError, ValueError, KeyError, TypeError):
        pass
    raise Failure(3, f"{path}: not a table.json of this program")


def rows_of(arguments, out, work):
    """One for each recording and condition; what fails has a problem in place of figures."""
    recordings = [(path, arguments.name or path.name, None) for path in arguments.paths]
    recordings += [(None, arguments.name or f"synth-{scene}", scene) for scene in arguments.scenes]
    for path, shown, scene in recordings:
        recording = problem = None
        try:
            recording = Recording(arguments, path or render(arguments, scene, work), work / "made")
            if not len(recording.truth):
                print(f"benchmark: {path}: no ground truth in TUM format, no errors; give --ground-truth",
                      file=sys.stderr)
        except Failure as failure:
            problem = str(failure)
        for name in arguments.wanted:
            row = {"recording": shown, "condition": name}
            try:
                row |= measure(arguments, recording, name, out) if recording else {"runs": 0, "problem": problem}
            except Failure as failure:
                row |= {"runs": 0, "problem": str(failure)}
            print(f"{shown} {name}: {row.get('problem', 'done')}", file=sys.stderr)
            yield row


def benchmark(arguments):
    if arguments.list:
        print("\n".join(f"{name:13} {condition.text}" for name, condition in CONDITIONS.items()))
        return 0
    jobs = jobs_of(arguments)
    earlier = read_table(arguments.compare) if arguments.compare else None
    out = Path(arguments.out)
    work = Path(arguments.work) if arguments.work else out / "recordings"
    for folder in (out, work):
        folder.mkdir(parents=True, exist_ok=True)
    table = {"schema": 1, "protocol": protocol(arguments, jobs), "rows": []}
    for job in jobs:
        for row in rows_of(job, out, work):
            table["rows"].append(row)
            (out / "table.json").write_text(json.dumps(table, indent=1) + "\n")
    if arguments.store:
        Path(arguments.store).write_text(json.dumps(table, indent=1) + "\n")
    text = table_text(table)
    if earlier:
        text += "\n" + comparison_text(table, earlier, arguments.worse)
    (out / "table.md").write_text(text)
    print(text, end="")
    return 1 if any("problem" in row for row in table["rows"]) else 0


def main():
    try:
        return benchmark(parse_arguments(sys.argv[1:]))
    except Failure as failure:
        print(f"benchmark: {failure}", file=sys.stderr)
        return failure.code
    except OSError as problem:
        print(f"benchmark: {problem}", file=sys.stderr)
        return 4


if __name__ == "__main__":
    sys.exit(main())
