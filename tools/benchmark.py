#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Run unisim-replay on recordings and on worse versions of them, and print one table.

    tools/benchmark.py RECORDING... --out DIR
    tools/benchmark.py --synth room,corridor --conditions original,half,flicker --out DIR
    tools/benchmark.py RECORDING --out DIR --compare OLD/table.json

Recordings are what unisim-replay takes. Images of the conditions (--list names them) are made once and kept
under DIR/recordings (--work). DIR gets table.md and table.json, the protocol in both. Ground truth: a file in
TUM format, --ground-truth or groundtruth.txt in the recording; without one there are no errors, only coverage.
What follows a lone -- goes to unisim-replay as it stands. Needs numpy and OpenCV for Python.
"""
import argparse
import csv
import json
import os
import platform
import statistics
import subprocess
import sys
from pathlib import Path

try:
    import cv2
    import numpy as np
    from benchmark_conditions import CONDITIONS
    from benchmark_table import comparison_text, table_text
except ImportError as problem:
    sys.exit(f"benchmark: {problem}; install python3-numpy and python3-opencv")

TOOLS = Path(__file__).resolve().parent

class Failure(Exception):
    """One line for the user and an exit code."""

    def __init__(self, code, text):
        super().__init__(text)
        self.code = code


def names_or_file(text):
    """Names with commas between them, or a file with one a line."""
    path = Path(text)
    parts = path.read_text().split() if path.is_file() else text.split(",")
    return [part for part in parts if part]


def parse_arguments(argv):
    own, extra = (argv[:argv.index("--")], argv[argv.index("--") + 1:]) if "--" in argv else (argv, [])
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("recordings", nargs="*", metavar="RECORDING")
    add("--data", metavar="DIR", help="every folder in DIR is a recording")
    add("--synth", metavar="SCENES", help="render these scenes of unisim-synth: room,corridor,desk")
    add("--synth-frames", type=int, default=300, metavar="N", help="frames of each (300)")
    add("--synth-size", default="640x480", metavar="WxH")
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
    arguments = parser.parse_args(own)
    arguments.extra = extra
    return arguments


def checked(arguments):
    wanted = names_or_file(arguments.conditions) if arguments.conditions else list(CONDITIONS)
    for name in wanted:
        if name not in CONDITIONS:
            raise Failure(2, f"--conditions: {name} is not known; --list names them")
    try:
        offsets = [int(text) for text in arguments.offsets.split(",")]
    except ValueError:
        offsets = [-1]
    if min(offsets) < 0:
        raise Failure(2, f"--offsets is {arguments.offsets}, must be frame numbers, as 0,1,2")
    recordings = [Path(text) for text in arguments.recordings]
    if arguments.data:
        if not Path(arguments.data).is_dir():
            raise Failure(3, f"--data: {arguments.data} is no folder")
        recordings += sorted(path for path in Path(arguments.data).iterdir() if path.is_dir())
    for path in recordings:
        if not path.exists():
            raise Failure(3, f"{path}: no such recording")
    if not recordings and not arguments.synth:
        raise Failure(2, "give recordings, --data DIR or --synth SCENES")
    if arguments.ground_truth and len(recordings) != 1:
        raise Failure(2, "--ground-truth is that of one recording")
    return wanted, offsets, recordings


def call(arguments, program, *options):
    path = Path(arguments.bin) / program
    if not path.is_file():
        raise Failure(3, f"{path} is missing; build it, or give --bin DIR")
    return subprocess.run([str(path), *map(str, options)], capture_output=True, text=True)


def last_line(result):
    lines = (result.stderr.strip() or result.stdout.strip()).splitlines()
    return lines[-1] if lines else f"exit code {result.returncode}"


class Frames:
    """Images of a recording by number, read when they are asked for."""

    def __init__(self, arguments, path):
        result = call(arguments, "unisim-replay", path, "--list-frames", "--format", arguments.format, "--from",
                      arguments.first, *(["--to", arguments.last] if arguments.last >= 0 else []))
        if result.returncode != 0:
            raise Failure(3, last_line(result))
        rows = [json.loads(line) for line in result.stdout.splitlines()]
        self.files = [row["file"] for row in rows]
        self.times = [row["time"] for row in rows]
        if len(rows) < 10:
            raise Failure(3, f"{path}: {len(rows)} frames; a recording needs at least 10")
        if len(set(self.files)) < len(rows):
            raise Failure(3, f"{path}: frames are not files of their own; take the video apart into images first")
        self.step = statistics.median(b - a for a, b in zip(self.times, self.times[1:]))

    def __len__(self):
        return len(self.files)

    def __getitem__(self, i):
        image = cv2.imread(self.files[i])
        if image is None:
            raise Failure(3, f"{self.files[i]}: cannot be read")
        return image


def read_poses(path):
    poses = []
    for number, line in enumerate(Path(path).read_text().splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        try:
            values = [float(word) for word in line.split()]
        except ValueError:
            values = []
        if len(values) != 8:
            raise Failure(3, f"{path}:{number}: not time x y z qx qy qz qw")
        poses.append(values)
    return np.array(sorted(poses)).reshape(-1, 8)


class Recording:
    def __init__(self, arguments, path, work):
        self.name, self.frames = path.name, Frames(arguments, path)
        self.folder = work / path.name
        truth = arguments.ground_truth or path / "groundtruth.txt"
        self.truth = read_poses(truth) if Path(truth).is_file() else np.zeros((0, 8))
        if arguments.ground_truth and not len(self.truth):
            raise Failure(3, f"{arguments.ground_truth}: no poses")
        self.focal, self.focal_known = arguments.true_focal, arguments.true_focal is not None
        card = path / "camera.toml"
        if self.focal is None and card.is_file():
            values = dict(line.split(" = ", 1) for line in card.read_text().splitlines() if " = " in line)
            self.focal, self.focal_known = float(values["fx"]), True
        if self.focal is None:
            self.focal = 0.85 * max(self.frames[0].shape[:2])

    def pose_text(self, index):
        """Ground truth of a frame, "" where there is none within half a frame."""
        time = self.frames.times[index]
        at = int(np.abs(self.truth[:, 0] - time).argmin()) if len(self.truth) else -1
        if at < 0 or abs(self.truth[at, 0] - time) > 0.51 * self.frames.step:
            return ""
        return " ".join(f"{value:.9g}" for value in self.truth[at, 1:])

    def degraded(self, condition):
        """The folder of a condition, in the layout of TUM; made where it is not there yet."""
        key = f"{condition.make.__name__}-q{condition.quality}-{len(self.frames)}"
        folder = self.folder / key
        done = {"first": self.frames.files[0], "last": self.frames.files[-1], "focal": self.focal,
                "truth": len(self.truth)}
        mark = folder / "made.json"
        if mark.is_file() and json.loads(mark.read_text()) == done:
            return folder
        (folder / "rgb").mkdir(parents=True, exist_ok=True)
        step = self.frames.step * condition.every
        with open(folder / "rgb.txt", "w") as images, open(folder / "groundtruth.txt", "w") as truth:
            for number, (image, index) in enumerate(condition.make(self.frames, self.focal)):
                name = f"rgb/{number:06d}.jpg"
                cv2.imwrite(str(folder / name), image, [cv2.IMWRITE_JPEG_QUALITY, condition.quality])
                images.write(f"{number * step:.6f} {name}\n")
                pose = self.pose_text(index) if index is not None else ""
                if pose:
                    truth.write(f"{number * step:.6f} {pose}\n")
        if not (folder / "groundtruth.txt").stat().st_size:
            (folder / "groundtruth.txt").unlink()
        mark.write_text(json.dumps(done))
        return folder


def path_length(truth, begin, end):
    inside = truth[(truth[:, 0] >= begin) & (truth[:, 0] <= end), 1:4]
    return float(np.linalg.norm(np.diff(inside, axis=0), axis=1).sum()) if len(inside) > 1 else 0.0


def figures(folder, out, focal_true):
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
    length = path_length(read_poses(folder / "groundtruth.txt"), times[longest["first"]], times[longest["last"]])
    if length > 0:
        row["ate_share"] = row["ate_m"] / length
    return row


def measure(arguments, recording, name, offsets, out):
    """One row: medians over the offsets."""
    condition = CONDITIONS[name]
    folder = recording.degraded(condition)
    focal = recording.focal * condition.focal
    runs, problem = [], ""
    for offset in offsets:
        target = out / "runs" / f"{recording.name}-{name}-{offset}"
        result = call(arguments, "unisim-replay", folder, "--format", "tum", "--from", offset, "--predictor",
                      arguments.predictor, "--out", target, "--force", "--quiet", "--no-report",
                      *condition.replay(focal), *arguments.extra)
        if result.returncode == 2:
            raise Failure(2, last_line(result))
        if result.returncode == 0:
            runs.append(figures(folder, target, focal if recording.focal_known else 0))
        else:
            problem = last_line(result)
    row = {"recording": recording.name, "condition": name, "runs": len(runs), "failed": len(offsets) - len(runs)}
    for key in sorted({key for run in runs for key in run}):
        values = [run[key] for run in runs if run.get(key) is not None]
        if values:
            row[key] = statistics.median(values)
    errors = [run["ate_m"] for run in runs if "ate_m" in run]
    if len(errors) > 1:
        row["ate_worst_m"] = max(errors)
    if problem:
        row["problem"] = problem
    return row


def render(arguments, scene, work):
    """A synthetic recording, rendered once."""
    folder = work / f"synth-{scene}"
    result = call(arguments, "unisim-synth", folder, "--scene", scene, "--frames", arguments.synth_frames, "--size",
                  arguments.synth_size, "--loops", 1, "--noise", "--blur", "--force")
    if result.returncode != 0:
        raise Failure(result.returncode, last_line(result))
    return folder


def protocol(arguments, offsets):
    version = call(arguments, "unisim-replay", "--version").stdout.strip()
    cpu = next((text.split(":", 1)[1].strip() for text in Path("/proc/cpuinfo").read_text().splitlines()
                if text.startswith("model name")), platform.processor()) if Path("/proc/cpuinfo").is_file() else ""
    return {"program": version, "predictor": " ".join([arguments.predictor, *arguments.extra]),
            "frames": f"[{arguments.first}, {arguments.last if arguments.last >= 0 else 'end'})",
            "first frames": ", ".join(map(str, offsets)) + "; figures are medians of these runs",
            "alignment": "Sim(3) on keyframes, the longest segment and all together",
            "ground truth": arguments.ground_truth or "groundtruth.txt of each recording, nearest in time",
            "machine": f"{cpu}, {os.cpu_count()} cores, {platform.system()} {platform.machine()}"}


def read_table(path):
    try:
        table = json.loads(Path(path).read_text())
        if table["schema"] == 1 and isinstance(table["rows"], list):
            return table
    except (OSError, ValueError, KeyError, TypeError):
        pass
    raise Failure(3, f"{path}: not a table.json of this program")


def benchmark(arguments):
    if arguments.list:
        print("\n".join(f"{name:13} {condition.text}" for name, condition in CONDITIONS.items()))
        return
    wanted, offsets, paths = checked(arguments)
    earlier = read_table(arguments.compare) if arguments.compare else None
    out = Path(arguments.out)
    work = Path(arguments.work) if arguments.work else out / "recordings"
    for folder in (out, work):
        folder.mkdir(parents=True, exist_ok=True)
    scenes = names_or_file(arguments.synth) if arguments.synth else []
    paths += [render(arguments, scene, work) for scene in scenes]
    table = {"schema": 1, "protocol": protocol(arguments, offsets), "rows": []}
    for path in paths:
        recording = Recording(arguments, path, work / "made")
        if not len(recording.truth):
            print(f"benchmark: {path}: no ground truth in TUM format, no errors; give --ground-truth", file=sys.stderr)
        for name in wanted:
            table["rows"].append(measure(arguments, recording, name, offsets, out))
            print(f"{recording.name} {name} done", file=sys.stderr)
            (out / "table.json").write_text(json.dumps(table, indent=1) + "\n")
    if arguments.store:
        Path(arguments.store).write_text(json.dumps(table, indent=1) + "\n")
    text = table_text(table)
    if earlier:
        text += "\n" + comparison_text(table, earlier, arguments.worse)
    (out / "table.md").write_text(text)
    print(text, end="")


def main():
    try:
        benchmark(parse_arguments(sys.argv[1:]))
    except Failure as failure:
        print(f"benchmark: {failure}", file=sys.stderr)
        return failure.code
    except OSError as problem:
        print(f"benchmark: {problem}", file=sys.stderr)
        return 4
    return 0


if __name__ == "__main__":
    sys.exit(main())
