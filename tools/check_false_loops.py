#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Count false loops: recordings by themselves, and mixes of each two, which have no place in common.

    tools/check_false_loops.py --suite tools/false_loops_suite.txt --out DIR
    tools/check_false_loops.py --suite FILE --alone --only room,desk --out DIR

Each line of a suite is one recording: NAME, then a folder or a video, or `synth` with options of unisim-synth, then
what unisim-replay is to be told of it (--from, --to, --format). $NAMES are replaced.

alone  every recording that has depth images and true poses. A loop is false where less than a tenth of what either of
       the two cameras sees is in view of the other, by depth and poses. Beside: the error with loops and without
mixes  every pair of recordings: the images of the first, then those of the second, as one film of 640x480 (images are
       scaled until they cover that, and cut). Looks across are keyframes of one that were compared with a keyframe of
       the other. False: one that was accepted and not withdrawn; a keyframe posed in a segment of the other recording
Keyframes by motion, focal length unknown; of a run with more looks than the program keeps, the newest. Needs numpy and
OpenCV for Python. 0: none is false; 1: some are; 3: a run failed.
"""
import argparse
import csv
import itertools
import json
import os
import shlex
import subprocess
import sys
from pathlib import Path

try:
    import cv2
    import numpy as np
    from benchmark_recording import Failure, Recording, call, last_line, pose_lines
except ImportError as problem:
    sys.exit(f"check_false_loops: {problem}; install python3-numpy and python3-opencv")

ROOT = Path(__file__).resolve().parent.parent
SHARED = 0.1      # of one camera's pixels, in view of the other: the same place
SAME_DEPTH = 0.1  # relative
GRID = 16         # every so many pixels of a depth image is looked for


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--suite", required=True, metavar="FILE")
    add("--out", required=True, metavar="DIR")
    add("--mixes", action="store_true", help="only these")
    add("--alone", action="store_true", help="only these")
    add("--only", metavar="NAMES", help="recordings, with commas between them (all)")
    add("--size", default="640x480", metavar="WxH", help="of all images (640x480)")
    add("--bin", default=str(ROOT / "build/release/bin"), metavar="DIR", help="the programs")
    given = parser.parse_args()
    try:
        given.size = tuple(int(side) for side in given.size.split("x"))
        if len(given.size) != 2 or min(given.size) < 64:
            raise ValueError
    except ValueError:
        parser.error("--size must be WxH, 64x64 or more")
    return given


class Film:
    """One recording: its images at the common size, made once."""

    def __init__(self, given, words, work):
        self.name, self.source, self.size = words[0], words[1], given.size
        folder, rest = work / self.name, words[2:]
        if self.source == "synth":
            made = work / f"{self.name}-rendered"
            if not (made / "groundtruth.txt").is_file():
                self.render(given, made, rest)
            self.source, rest = made, []
        options = argparse.ArgumentParser()
        options.add_argument("--from", type=int, default=0, dest="first")
        options.add_argument("--to", type=int, default=-1, dest="last")
        options.add_argument("--format", default="auto")
        options.add_argument("--ground-truth")
        options.add_argument("--depth-camera", help="fx,fy,cx,cy of the depth images")
        told = options.parse_args(rest)
        told.bin, told.name, told.true_focal = given.bin, self.name, None
        self.told = told
        self.recording = Recording(told, Path(self.source), work / "made")
        self.images = folder
        self.write()

    @staticmethod
    def render(given, folder, options):
        result = call(given, "unisim-synth", folder, "--size", "{}x{}".format(*given.size), *options, "--force")
        if result.returncode != 0:
            raise Failure(3, last_line(result))

    def write(self):
        frames = self.recording.frames
        self.files = [self.images / f"{k:06d}.jpg" for k in range(len(frames))]
        if self.files[-1].is_file():
            return
        self.images.mkdir(parents=True, exist_ok=True)
        for k, path in enumerate(self.files):
            cv2.imwrite(str(path), covering(frames[k], self.size), [cv2.IMWRITE_JPEG_QUALITY, 95])

    def view(self, frame):
        """Depth in metres, intrinsics and pose of the frame nearest to `frame` that has them; None without."""
        for k in sorted(range(len(self.files)), key=lambda k: abs(k - frame))[:9]:
            depth, pose = self.depth(k), self.recording.pose(k)
            if depth is not None and pose is not None:
                return depth, self.depth_camera(), pose_matrix(pose)
        return None

    def depth(self, frame):
        file = Path(self.recording.frames.files[frame])
        tum, pair = file.parent.parent / "depth" / f"{file.stem}.png", Path(str(file).split(".color.")[0] + ".depth.png")
        for path, unit in ((tum, 5000.0), (pair, 1000.0)):
            image = cv2.imread(str(path), cv2.IMREAD_UNCHANGED) if path.is_file() else None
            if image is not None:
                return np.where(image == 65535, 0, image) / unit
        return None

    def depth_camera(self):
        if self.told.depth_camera:
            return [float(word) for word in self.told.depth_camera.split(",")]
        lines = (Path(self.source) / "camera.toml").read_text().splitlines()
        values = dict(line.split(" = ", 1) for line in lines if " = " in line)
        return [float(values[name]) for name in ("fx", "fy", "cx", "cy")]


def covering(image, wanted):
    """Scaled until it covers the size, and cut to it."""
    height, width = image.shape[:2]
    scale = max(wanted[0] / width, wanted[1] / height)
    size = (max(wanted[0], round(width * scale)), max(wanted[1], round(height * scale)))
    image = cv2.resize(image, size, interpolation=cv2.INTER_AREA if scale < 1 else cv2.INTER_LINEAR)
    left, top = (size[0] - wanted[0]) // 2, (size[1] - wanted[1]) // 2
    return image[top:top + wanted[1], left:left + wanted[0]]


def pose_matrix(row):
    x, y, z, w = row[3:] / np.linalg.norm(row[3:])
    matrix = np.eye(4)
    matrix[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                      [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                      [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    matrix[:3, 3] = row[:3]
    return matrix


def shared(one, other):
    """Share of what camera `one` sees that `other` sees too."""
    depth, (fx, fy, cx, cy), pose = one
    v, u = np.mgrid[GRID // 2:depth.shape[0]:GRID, GRID // 2:depth.shape[1]:GRID]
    z = depth[v, u]
    seen = z > 0
    points = np.stack([(u - cx) / fx * z, (v - cy) / fy * z, z, np.ones_like(z)], -1)[seen]
    depth2, (fx2, fy2, cx2, cy2), pose2 = other
    there = points @ (np.linalg.inv(pose2) @ pose).T
    there = there[there[:, 2] > 1e-6]
    a = np.round(there[:, 0] / there[:, 2] * fx2 + cx2).astype(int)
    b = np.round(there[:, 1] / there[:, 2] * fy2 + cy2).astype(int)
    inside = (a >= 0) & (a < depth2.shape[1]) & (b >= 0) & (b < depth2.shape[0])
    measured = depth2[b[inside], a[inside]]
    same = (measured > 0) & (np.abs(measured / there[inside, 2] - 1) < SAME_DEPTH)
    return float(same.sum()) / max(1, len(points))


def replay(given, folder, out, *options):
    """@return summary, rows of places.csv, rows of keyframes.csv; None: it found no start"""
    result = call(given, "unisim-replay", folder, "--format", "tum", "--out", out, "--force", "--quiet", "--no-report",
                  *options)
    if result.returncode == 3 and "no start" in result.stderr:
        return None
    if result.returncode != 0:
        raise Failure(3, f"{folder}: {last_line(result)}")
    read = lambda name: list(csv.DictReader(open(out / name)))  # noqa: E731
    return json.loads((out / "summary.json").read_text()), read("places.csv"), read("keyframes.csv")


def mix(given, one, other, work):
    """One pair: looks across, of these accepted, keyframes posed in the other's segment, segments of both."""
    folder = work / f"{one.name}+{other.name}"
    folder.mkdir(parents=True, exist_ok=True)
    files = one.files + other.files
    (folder / "rgb.txt").write_text("".join(f"{k / 30:.6f} {os.path.relpath(file, folder)}\n"
                                            for k, file in enumerate(files)))
    run = replay(given, folder, folder / "out")
    row = {"mix": f"{one.name} + {other.name}", "looks": 0, "across": 0, "accepted": 0, "posed": 0, "segments": 0}
    if run is None:
        return row | {"note": "no start"}
    summary, places, keyframes = run
    border = (len(one.files) - 0.5) / 30
    later = {int(k["id"]): float(k["timestamp"]) > border for k in keyframes}
    across = [p for p in places if later[int(p["keyframe"])] != later[int(p["candidate"])]]
    owners = {}
    for k in keyframes:
        if float(k["confidence"]) > 0:
            owners.setdefault(k["segment"], []).append(later[int(k["id"])])
    posed = sum(min(sum(owner), len(owner) - sum(owner)) for owner in owners.values())
    return row | {"looks": len(places), "across": len(across), "posed": posed, "segments": summary["segments"],
                  "accepted": sum(p["accepted"] == "1" for p in across)}


def alone(given, film, work):
    """One recording: loops that were accepted, how much those cameras share, the error with and without loops."""
    if film.view(0) is None:
        return None
    folder = work / f"{film.name}-alone"
    folder.mkdir(parents=True, exist_ok=True)
    times = film.recording.frames.times
    (folder / "rgb.txt").write_text("".join(f"{time:.6f} {os.path.relpath(file, folder)}\n"
                                            for time, file in zip(times, film.files)))
    truth = folder / "groundtruth.txt"
    truth.write_text(pose_lines(film.recording.truth))
    config = work / "no_loops.toml"
    config.write_text("[geometric]\nloop_tries = 0\n")
    row = {"recording": film.name, "looks": 0, "accepted": 0, "false": 0}
    runs = [replay(given, folder, folder / name, "--ground-truth", truth, *more)
            for name, more in (("out", ()), ("without", ("--config", config)))]
    if runs[0] is None:
        return row | {"note": "no start"}
    summary, places, keyframes = runs[0]
    when = {int(k["id"]): float(k["timestamp"]) for k in keyframes}
    frame = {key: int(np.abs(np.array(times) - time).argmin()) for key, time in when.items()}
    shares = []
    for place in places:
        if place["accepted"] == "1":
            views = [film.view(frame[int(place[key])]) for key in ("keyframe", "candidate")]
            if None not in views:
                shares.append(max(shared(*views), shared(*views[::-1])))
    return row | {"looks": len(places), "accepted": sum(p["accepted"] == "1" for p in places),
                  "judged": len(shares), "false": sum(share < SHARED for share in shares),
                  "least": min(shares, default=None), "ate_m": summary["ate_rmse_m"],
                  "ate_without_m": runs[1][0]["ate_rmse_m"] if runs[1] else None}


def text_of(value):
    return "" if value is None else f"{value:.4f}" if isinstance(value, float) else str(value)


def print_table(rows, columns):
    print("| " + " | ".join(columns.values()) + " |\n|" + "---|" * len(columns))
    for row in rows:
        print("| " + " | ".join(text_of(row.get(key)) for key in columns) + " |")


def films_of(given, work):
    lines = (shlex.split(os.path.expandvars(line), comments=True) for line in Path(given.suite).read_text().splitlines())
    wanted = given.only.split(",") if given.only else None
    return [Film(given, words, work) for words in lines if words and (not wanted or words[0] in wanted)]


def check(given):
    work = Path(given.out)
    work.mkdir(parents=True, exist_ok=True)
    films = films_of(given, work)
    table = {"mixes": [], "alone": []}
    if not given.mixes:
        table["alone"] = [row for row in (alone(given, film, work) for film in films) if row]
        print_table(table["alone"], {"recording": "alone", "looks": "looks", "accepted": "accepted", "judged": "judged",
                                     "false": "false", "least": "least share", "ate_m": "ATE m",
                                     "ate_without_m": "without loops m", "note": ""})
    if not given.alone:
        table["mixes"] = [mix(given, one, other, work) for one, other in itertools.combinations(films, 2)]
        print_table(table["mixes"], {"mix": "mix", "across": "looks across", "accepted": "accepted",
                                     "posed": "posed across", "segments": "segments", "note": ""})
        looks, accepted, posed = (sum(row[key] for row in table["mixes"]) for key in ("across", "accepted", "posed"))
        print(f"{len(table['mixes'])} mixes: {looks} looks across, {accepted} accepted, {posed} keyframes posed across")
    (work / "false_loops.json").write_text(json.dumps(table, indent=1) + "\n")
    wrong = sum(row["accepted"] + row["posed"] for row in table["mixes"]) + sum(row["false"] for row in table["alone"])
    return 1 if wrong else 0


def main():
    given = parse_arguments()
    try:
        return check(given)
    except Failure as failure:
        print(f"check_false_loops: {failure}", file=sys.stderr)
        return failure.code
    except subprocess.SubprocessError as problem:
        print(f"check_false_loops: {problem}", file=sys.stderr)
        return 3


if __name__ == "__main__":
    sys.exit(main())
