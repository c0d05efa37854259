# SPDX-License-Identifier: MIT
"""Recordings for benchmark.py: their images and true poses, and the folders of their conditions."""
import json
import re
import statistics
import subprocess
from pathlib import Path

import cv2
import numpy as np


class Failure(Exception):
    """One line for the user and an exit code."""

    def __init__(self, code, text):
        super().__init__(text)
        self.code = code


def call(arguments, program, *options):
    path = Path(arguments.bin) / program
    if not path.is_file():
        raise Failure(3, f"{path} is missing; build it, or give --bin DIR")
    return subprocess.run([str(path), *map(str, options)], capture_output=True, text=True, errors="replace")


def last_line(result):
    lines = (result.stderr.strip() or result.stdout.strip()).splitlines()
    return lines[-1] if lines else f"exit code {result.returncode}"


class Video:
    """Frames of a video by number; going on to a later one is cheap, going back begins anew."""

    def __init__(self, path, stretched):
        self.path, self.stretched = path, stretched
        self.reader, self.next, self.kept = None, 0, {}

    def __getitem__(self, number):
        if number in self.kept:
            return self.kept[number]
        if self.reader is None or number < self.next:
            self.reader, self.next, self.kept = cv2.VideoCapture(self.path), 0, {}
        image = None
        while self.next <= number:
            good, image = self.reader.read()
            if not good:
                raise Failure(3, f"{self.path}: frame {self.next} cannot be read")
            self.next += 1
        if self.stretched:
            image = cv2.resize(image, tuple(self.stretched), interpolation=cv2.INTER_AREA)
        self.kept = {key: kept for key, kept in self.kept.items() if key == number - 1} | {number: image}
        return image


class Frames:
    """Images of a recording by number, read when they are asked for."""

    def __init__(self, arguments, path):
        last = ["--to", arguments.last] if arguments.last >= 0 else []
        result = call(arguments, "unisim-replay", path, "--list-frames", "--format", arguments.format, "--from",
                      arguments.first, *last)
        if result.returncode != 0:
            raise Failure(3, last_line(result))
        rows = [json.loads(line) for line in result.stdout.splitlines()]
        if len(rows) < 10:
            raise Failure(3, f"{path}: {len(rows)} frames; a recording needs at least 10")
        self.files = [row["file"] for row in rows]
        self.numbers = [row["index"] for row in rows]
        self.times = [row["time"] for row in rows]
        self.depth_bits = rows[0].get("bits", 8)
        self.video = Video(self.files[0], rows[0].get("stretched")) if self.files[0] == self.files[-1] else None
        self.step = statistics.median(b - a for a, b in zip(self.times, self.times[1:]))

    def __len__(self):
        return len(self.files)

    def __getitem__(self, i):
        if self.video:
            return self.video[self.numbers[i]]
        wide = self.depth_bits > 8
        image = cv2.imread(self.files[i], cv2.IMREAD_COLOR | cv2.IMREAD_ANYDEPTH if wide else cv2.IMREAD_COLOR)
        if image is None:
            raise Failure(3, f"{self.files[i]}: cannot be read")
        return (image >> (self.depth_bits - 8)).astype(np.uint8) if image.dtype == np.uint16 else image


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


def quaternion(rotation):
    """x y z w: of the four squares the largest divides, so that no small number does."""
    r = rotation
    w, x, y, z = 1 + r.trace(), 1 + 2 * r[0, 0] - r.trace(), 1 + 2 * r[1, 1] - r.trace(), 1 + 2 * r[2, 2] - r.trace()
    rows = {w: (r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1], w),
            x: (x, r[0, 1] + r[1, 0], r[0, 2] + r[2, 0], r[2, 1] - r[1, 2]),
            y: (r[0, 1] + r[1, 0], y, r[1, 2] + r[2, 1], r[0, 2] - r[2, 0]),
            z: (r[0, 2] + r[2, 0], r[1, 2] + r[2, 1], z, r[1, 0] - r[0, 1])}
    best = np.array(rows[max(rows)])
    return best / np.linalg.norm(best)


def poses_beside_images(frames):
    """The 4x4 matrices of 7-Scenes, one file an image; images without one have no pose."""
    poses = []
    for file, time in zip(frames.files, frames.times):
        path = Path(re.sub(r"\.color\.\w+$", ".pose.txt", file))
        if path.suffix == ".txt" and path.is_file():
            matrix = np.loadtxt(path)
            if matrix.shape == (4, 4) and np.isfinite(matrix).all():
                poses.append([time, *matrix[:3, 3], *quaternion(matrix[:3, :3])])
    return np.array(poses).reshape(-1, 8)


def pose_lines(poses):
    return "".join(f"{row[0]:.6f} " + " ".join(f"{value:.9g}" for value in row[1:]) + "\n" for row in poses)


class Recording:
    def __init__(self, arguments, path, work):
        self.name, self.path = arguments.name or path.name, path
        self.folder = work / self.name
        self.frames = Frames(arguments, path)
        truth = arguments.ground_truth or path / "groundtruth.txt"
        self.truth = read_poses(truth) if Path(truth).is_file() else poses_beside_images(self.frames)
        if arguments.ground_truth and not len(self.truth):
            raise Failure(3, f"{arguments.ground_truth}: no poses")
        self.focal, self.focal_known = arguments.true_focal, arguments.true_focal is not None
        card = path / "camera.toml"
        if self.focal is None and card.is_file():
            values = dict(line.split(" = ", 1) for line in card.read_text().splitlines() if " = " in line)
            self.focal, self.focal_known = float(values["fx"]), True
        if self.focal is None:
            self.focal = 0.85 * max(self.frames[0].shape[:2])

    def pose(self, index):
        """Ground truth of a frame, None where there is none within half a frame."""
        time = self.frames.times[index]
        at = int(np.abs(self.truth[:, 0] - time).argmin()) if len(self.truth) else -1
        if at < 0 or abs(self.truth[at, 0] - time) > 0.51 * self.frames.step:
            return None
        return self.truth[at, 1:]

    def degraded(self, condition):
        """The folder of a condition, in the layout of TUM; made where it is not there yet."""
        folder = self.folder / f"{condition.make.__name__}-q{condition.quality}-{len(self.frames)}"
        done = {"first": [self.frames.files[0], self.frames.numbers[0]], "last": self.frames.files[-1],
                "focal": self.focal, "truth": len(self.truth)}
        mark = folder / "made.json"
        if mark.is_file() and json.loads(mark.read_text()) == done:
            return folder
        (folder / "rgb").mkdir(parents=True, exist_ok=True)
        step, poses = self.frames.step * condition.every, []
        with open(folder / "rgb.txt", "w") as images:
            for number, (image, index) in enumerate(condition.make(self.frames, self.focal)):
                name = f"rgb/{number:06d}.jpg"
                if not cv2.imwrite(str(folder / name), image, [cv2.IMWRITE_JPEG_QUALITY, condition.quality]):
                    raise OSError(f"{folder / name}: cannot be written")
                images.write(f"{number * step:.6f} {name}\n")
                pose = self.pose(index) if index is not None else None
                if pose is not None:
                    poses.append([number * step, *pose])
        (folder / "groundtruth.txt").unlink(missing_ok=True)
        if poses:
            (folder / "groundtruth.txt").write_text(pose_lines(poses))
        mark.write_text(json.dumps(done))
        return folder

    def own_truth(self):
        """A file with the true poses, in the time of the recording itself."""
        self.folder.mkdir(parents=True, exist_ok=True)
        path = self.folder / "groundtruth.txt"
        path.write_text(pose_lines(self.truth))
        return path


def path_length(truth, begin, end):
    inside = truth[(truth[:, 0] >= begin) & (truth[:, 0] <= end), 1:4]
    return float(np.linalg.norm(np.diff(inside, axis=0), axis=1).sum()) if len(inside) > 1 else 0.0
