#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Check maps that outlive the run on a recording: saved, gone on with, looked into, killed while they are saved.

    tools/check_maps.py RECORDING --ground-truth FILE --out DIR
    tools/check_maps.py RECORDING --ground-truth FILE --strangers OTHER --kills 100 --out DIR

localise   the map is made without the held-back frames; each of these is then looked for by itself, in shuffled
           order, so that nothing can be followed. Error: distance to the ground truth after the alignment (Sim(3)) of
           the map's own keyframes
go on      the first half, saved; the second half in that map; ATE of all keyframes beside one run over both
strangers  frames of other recordings, brought to the map's size, looked for in the map: none may be found
kills      kill -9 at random times while a map is saved: what is there afterwards is the old map or the new one

Ground truth is in TUM format, with the times that unisim-replay --list-frames gives. Needs numpy and OpenCV for Python.
"""
import argparse
import json
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

try:
    import cv2
    import numpy as np
except ImportError as problem:
    sys.exit(f"check_maps: {problem}; install python3-numpy and python3-opencv")

ROOT = Path(__file__).resolve().parent.parent
NEAR_S = 0.02  # as unisim-eval


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("recording")
    add("--ground-truth", required=True, metavar="FILE")
    add("--format", default="auto")
    add("--from", type=int, default=0, dest="first", metavar="A")
    add("--to", type=int, default=500, dest="last", metavar="B", help="frames [A, B) (0, 500)")
    add("--stride", type=int, default=5, help="of the keyframes (5)")
    add("--held-back", type=int, default=50, metavar="N", help="frames that are asked for (50)")
    add("--within", type=float, default=0.05, metavar="M", help="metres that count as found (0.05)")
    add("--seed", type=int, default=1)
    add("--strangers", nargs="*", default=[], metavar="RECORDING")
    add("--kills", type=int, default=0, metavar="N")
    add("--out", required=True, metavar="DIR", help="a folder that is not there yet")
    add("--bin", default=str(ROOT / "build/release/bin"), metavar="DIR", help="the programs")
    return parser.parse_args()


class Check:
    def __init__(self, arguments):
        self.given = arguments
        self.out = Path(arguments.out).absolute()
        self.out.mkdir(parents=True)
        self.replay_program = str(Path(arguments.bin) / "unisim-replay")

    def replay(self, *words, name=None, fine=(0,)):
        """One run of unisim-replay. @return its summary, None without one"""
        command = [self.replay_program, *map(str, words), "--quiet", "--no-report", "--force"]
        if name:
            command += ["--out", str(self.out / name)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode not in fine:
            sys.exit(f"check_maps: {' '.join(command)}\n{done.stderr}")
        summary = self.out / (name or "") / "summary.json"
        return json.loads(summary.read_text()) if name and summary.is_file() else None

    def frames(self, recording, first=None, last=None, fmt="auto"):
        command = [self.replay_program, str(recording), "--list-frames", "--format", fmt]
        if last is not None:
            command += ["--from", str(first), "--to", str(last)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            sys.exit(f"check_maps: {done.stderr.strip()}")
        return [json.loads(line) for line in done.stdout.splitlines()]

    def sequence(self, name, frames, times):
        """A recording in TUM's format whose list names images that lie elsewhere."""
        folder = self.out / name
        folder.mkdir()
        lines = [f"{t:.6f} {Path(frame['file']).absolute()}" for frame, t in zip(frames, times)]
        (folder / "rgb.txt").write_text("# timestamp filename\n" + "\n".join(lines) + "\n")
        return folder


def read_tum(path):
    rows = [line.split() for line in Path(path).read_text().splitlines() if line and line[0] != "#"]
    return np.array(rows, dtype=float).reshape(-1, len(rows[0]) if rows else 8)


def partners(times, truth):
    """For each time the row of the ground truth next to it, -1 for none."""
    nearest = np.abs(truth[:, 0][None, :] - np.asarray(times)[:, None]).argmin(axis=1)
    return np.where(np.abs(truth[nearest, 0] - times) <= NEAR_S, nearest, -1)


def similarity(source, target):
    """Umeyama: scale, rotation, translation that take source to target."""
    middle_s, middle_t = source.mean(axis=0), target.mean(axis=0)
    u, d, vt = np.linalg.svd((target - middle_t).T @ (source - middle_s) / len(source))
    sign = np.diag([1, 1, np.sign(np.linalg.det(u @ vt))])
    rotation = u @ sign @ vt
    scale = np.trace(np.diag(d) @ sign) / ((source - middle_s) ** 2).sum(axis=1).mean()
    return scale, rotation, middle_t - scale * rotation @ middle_s


def localise(check, truth):
    given = check.given
    frames = check.frames(given.recording, given.first, given.last, given.format)
    # Halfway between keyframes as they would be, spread over all.
    may = [k for k in range(given.stride, len(frames) - given.stride) if k % given.stride == given.stride // 2]
    chosen = [may[i] for i in np.linspace(0, len(may) - 1, min(given.held_back, len(may))).round().astype(int)]
    chosen = sorted(set(chosen))
    rest = [k for k in range(len(frames)) if k not in set(chosen)]
    map_file = check.out / "room.map"
    seen = check.sequence("seen", [frames[k] for k in rest], [frames[k]["time"] for k in rest])
    made = check.replay(seen, "--stride", given.stride, "--ground-truth", given.ground_truth, "--save-map", map_file,
                        name="map")
    order = list(chosen)
    random.Random(given.seed).shuffle(order)
    asked = check.sequence("asked", [frames[k] for k in order], range(1, len(order) + 1))
    start = time.monotonic()
    told = check.replay(asked, "--load-map", map_file, "--localise", name="localised", fine=(0, 3))
    wall = time.monotonic() - start
    keyframes = read_tum(check.out / "map/trajectory.tum")
    at = partners(keyframes[:, 0], truth)
    scale, rotation, shift = similarity(keyframes[at >= 0, 1:4], truth[at[at >= 0], 1:4])
    errors = {}
    for row in read_tum(check.out / "localised/trajectory.tum"):
        frame = order[round(row[0]) - 1]
        partner = partners([frames[frame]["time"]], truth)[0]
        if partner < 0:
            sys.exit("check_maps: a held-back frame has no ground truth")
        errors[frame] = float(np.linalg.norm(scale * rotation @ row[1:4] + shift - truth[partner, 1:4]))
    near = sum(error <= given.within for error in errors.values())
    values = sorted(errors.values()) or [float("nan")]
    print(f"localise: {len(rest)} frames seen, {made['keyframes']} keyframes, ATE of the map {made['ate_rmse_m']:.4f} m; "
          f"{map_file.stat().st_size / 1e6:.2f} MB")
    print(f"  {len(order)} held back: {told['located']} found, {near} within {given.within} m "
          f"({near / len(order):.2f}); error median {np.median(values):.4f}, "
          f"90 % {values[min(len(values) - 1, int(0.9 * len(values)))]:.4f}, largest {values[-1]:.4f} m")
    locate = told["timing_ms"]["locate"]
    print(f"  {locate['p50']:.1f} ms a frame (95 % {locate['p95']:.1f}, longest {locate['max']:.1f}); "
          f"whole run with loading {wall:.2f} s, peak memory {told['memory']['process_peak_bytes'] / 1e6:.0f} MB")
    return map_file, frames


def ate(check, trajectory):
    done = subprocess.run([str(Path(check.given.bin) / "unisim-eval"), "ate", check.given.ground_truth, str(trajectory),
                           "--align", "sim3", "--json"], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def go_on(check):
    given = check.given
    half = (given.first + given.last) // 2
    common = [given.recording, "--format", given.format, "--stride", given.stride, "--ground-truth", given.ground_truth]
    first, both = check.out / "first.map", check.out / "both.map"
    whole = check.replay(*common, "--from", given.first, "--to", given.last, name="whole")
    check.replay(*common, "--from", given.first, "--to", half, "--save-map", first, name="first")
    second = check.replay(*common, "--from", half, "--to", given.last, "--load-map", first, "--save-map", both,
                          name="second")
    together = ate(check, check.out / "second/trajectory_map.tum")
    print(f"go on: ATE over {together['protocol']['associated']} keyframes {together['rmse']:.4f} m, without interruption "
          f"{whole['ate_rmse_m']:.4f} m ({together['rmse'] / whole['ate_rmse_m']:.2f}); segments {second['segments']}, "
          f"posed {second['coverage']:.2f}")
    print(f"  map {first.stat().st_size / 1e6:.2f} MB, then {both.stat().st_size / 1e6:.2f} MB")


def strangers(check, map_file, frames):
    size = cv2.imread(frames[0]["file"]).shape[1::-1]
    for number, recording in enumerate(check.given.strangers):
        listed = check.frames(recording)
        step = max(1, len(listed) // 100)
        images = check.out / f"stranger{number}_images"
        images.mkdir()
        made = []
        for frame in listed[::step]:
            image = cv2.imread(frame["file"])
            if image is None:
                continue
            path = images / f"{frame['index']:06d}.png"
            cv2.imwrite(str(path), cv2.resize(image, size, interpolation=cv2.INTER_AREA))
            made.append({"file": str(path)})
        folder = check.sequence(f"stranger{number}", made, range(1, len(made) + 1))
        told = check.replay(folder, "--load-map", map_file, "--localise", name=f"stranger{number}_out", fine=(0, 3))
        print(f"strangers: {told['located']} of {told['frames']} frames of {recording} found")


def kills(check, frames):
    """Each round goes on in a copy of the old map and is killed while it puts the new one in its place."""
    given = check.given
    chance = random.Random(given.seed)
    old = check.out / "first.map"
    few = check.sequence("few", frames[:11], [frame["time"] for frame in frames[:11]])
    one = check.sequence("one", frames[:1], [1.0])
    path = check.out / "kill" / "room.map"
    path.parent.mkdir()
    command = [check.replay_program, str(few), "--stride", "5", "--load-map", str(path), "--save-map", str(path),
               "--quiet", "--no-report", "--force", "--out", str(check.out / "kill/out")]
    counts = {"old": 0, "new": 0}
    for _ in range(given.kills):
        shutil.copy(old, path)
        run = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        part = path.parent / f".room.map.{run.pid}.part"
        while run.poll() is None:
            try:
                if part.stat().st_size > 0:
                    break
            except OSError:
                pass
        time.sleep(chance.uniform(0, 0.01))
        run.send_signal(signal.SIGKILL)
        run.wait()
        kept = path.read_bytes() == old.read_bytes()
        counts["old" if kept else "new"] += 1
        check.replay(one, "--load-map", path, "--localise", name="kill/look")
    print(f"kills: {given.kills}, afterwards {counts['old']} times the old map, {counts['new']} times the new one; "
          "each loaded")


def main():
    given = parse_arguments()
    if Path(given.out).exists():
        sys.exit(f"check_maps: {given.out}: is there already; give another --out")
    check = Check(given)
    truth = read_tum(given.ground_truth)
    print(f"{given.recording}: frames [{given.first}, {given.last}), every {given.stride}th a keyframe, ground truth "
          f"{given.ground_truth}, seed {given.seed}")
    map_file, frames = localise(check, truth)
    go_on(check)
    strangers(check, map_file, frames)
    if given.kills > 0:
        kills(check, frames)


if __name__ == "__main__":
    main()
