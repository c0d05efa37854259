# SPDX-License-Identifier: MIT
"""benchmark.py on a small rendered recording: its table, its comparison, and what it refuses."""
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

try:
    import cv2
    import numpy as np
except ImportError as problem:
    print(f"skipped: {problem}")
    sys.exit(0)

from project import PROGRAMS, run_tool  # noqa: E402
from benchmark_conditions import BARREL, CONDITIONS  # noqa: E402
from benchmark_recording import quaternion  # noqa: E402
from benchmark_table import comparison_text  # noqa: E402


def run(*options):
    return run_tool("benchmark.py", "--bin", PROGRAMS, *options)


class Program(unittest.TestCase):
    def test_table_and_comparison(self):
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder) / "out"
            made = ["--synth", "desk", "--synth-frames", 90, "--synth-size", "160x120", "--conditions",
                    "original,noise", "--out", out]
            first = run(*made, "--store", out / "kept.json")
            self.assertEqual(first.returncode, 0, first.stderr)
            self.assertIn("| synth-desk | original |", first.stdout)
            self.assertIn("| synth-desk | noise |", first.stdout)
            self.assertEqual(first.stdout, (out / "table.md").read_text())
            table = json.loads((out / "kept.json").read_text())
            self.assertEqual(len(table["rows"]), 2)
            for row in table["rows"]:
                self.assertGreater(row["sigma_ratio"], 0)
                self.assertLessEqual(row["beyond_3_sigma"], 1)
                self.assertEqual(row["good_far_off"], 0)
            for name in ("program", "frames", "alignment", "ground truth", "machine", "first frames"):
                self.assertIn(name, table["protocol"])
            again = run(*made, "--compare", out / "kept.json")
            self.assertEqual(again.returncode, 0, again.stderr)
            self.assertIn("new over earlier", again.stdout)

    def test_a_row_that_fails_says_so_and_the_others_go_on(self):
        with tempfile.TemporaryDirectory() as folder:
            blank = Path(folder) / "blank"
            blank.mkdir()
            for number in range(12):
                cv2.imwrite(str(blank / f"{number:04d}.png"), np.full((120, 160, 3), 90, np.uint8))
            suite = Path(folder) / "suite.txt"
            suite.write_text(f"# two lines\n{blank} --name nothing --conditions original,known-focal,half\n"
                             "--synth desk --synth-frames 60 --synth-size 160x120 --name desk "
                             "--conditions original,known-focal -- --stride 2\n")
            done = run("--suite", suite, "--out", Path(folder) / "out")
            self.assertEqual(done.returncode, 1, done.stderr)
            self.assertNotIn("Traceback", done.stderr)
            rows = json.loads((Path(folder) / "out" / "table.json").read_text())["rows"]
            self.assertEqual([(row["recording"], "problem" in row) for row in rows],
                             [("nothing", True)] * 3 + [("desk", False)] * 2)
            self.assertIn("no start", rows[0]["problem"])
            self.assertIn("--true-focal", rows[1]["problem"])
            self.assertEqual(len([line for line in done.stdout.splitlines() if " failed: " in line]), 3)

    def test_a_video_is_a_recording(self):
        with tempfile.TemporaryDirectory() as folder:
            made = Path(folder) / "made"
            subprocess.run([Path(PROGRAMS) / "unisim-synth", made, "--scene", "desk", "--frames", "60", "--size",
                            "160x120"], check=True, capture_output=True)
            film = Path(folder) / "film.avi"
            writer = cv2.VideoWriter(str(film), cv2.VideoWriter_fourcc(*"MJPG"), 30, (160, 120))
            if not writer.isOpened():
                self.skipTest("this OpenCV writes no video")
            for name in sorted((made / "rgb").iterdir()):
                writer.write(cv2.imread(str(name)))
            writer.release()
            poses = np.loadtxt(made / "groundtruth.txt")
            poses[:, 0] -= poses[0, 0]
            np.savetxt(Path(folder) / "truth.txt", poses)
            out = Path(folder) / "out"
            done = run(film, "--ground-truth", Path(folder) / "truth.txt", "--conditions", "original,flicker,jump",
                       "--out", out)
            self.assertEqual(done.returncode, 0, done.stderr)
            rows = json.loads((out / "table.json").read_text())["rows"]
            self.assertTrue(all("ate_m" in row for row in rows), rows)

    def test_bad_input_is_refused_in_one_line(self):
        with tempfile.TemporaryDirectory() as folder:
            no_table = Path(folder) / "no.json"
            no_table.write_text("[]")
            bad_suite = Path(folder) / "suite.txt"
            bad_suite.write_text("--synth room\n--synth room --conditions blurr\n")
            cases = ((2, "--synth", ["--out", folder]),
                     (2, "blurr", ["--synth", "room", "--conditions", "blurr", "--out", folder]),
                     (2, "blurr", ["--suite", bad_suite, "--out", folder]),
                     (3, "nowhere", ["--suite", "nowhere", "--out", folder]),
                     (2, "--offsets", ["--synth", "room", "--offsets", "x", "--out", folder]),
                     (3, "nowhere", [Path(folder) / "nowhere", "--out", folder]),
                     (3, "no.json", ["--synth", "room", "--compare", no_table, "--out", folder]),
                     (3, "no program", ["--synth", "room", "--bin", "no program", "--out", folder]))
            for code, part, options in cases:
                refused = run(*options)
                self.assertEqual(refused.returncode, code, refused.stderr)
                self.assertIn(part, refused.stderr)
                self.assertEqual(len(refused.stderr.strip().splitlines()), 1, refused.stderr)


class Comparison(unittest.TestCase):
    def test_what_got_worse_is_named(self):
        row = {"recording": "a", "condition": "b", "ate_m": 0.1, "coverage": 1.0, "fps": 100.0}
        worse = dict(row, ate_m=0.12, fps=95.0)
        flagged = comparison_text({"rows": [worse]}, {"rows": [row]}, 0.1).splitlines()[-1]
        self.assertIn("1.20", flagged)
        self.assertTrue(flagged.endswith("| ate_m |"), flagged)
        believed, wrong = dict(row, good_far_off=0), dict(row, good_far_off=2)
        self.assertTrue(comparison_text({"rows": [wrong]}, {"rows": [believed]}, 0.1).endswith("| good_far_off |\n"))
        self.assertTrue(comparison_text({"rows": [believed]}, {"rows": [believed]}, 0.1).endswith("|  |\n"))
        lost = {key: value for key, value in row.items() if key != "ate_m"}
        self.assertIn("ate_m gone", comparison_text({"rows": [lost]}, {"rows": [row]}, 0.1))
        self.assertTrue(comparison_text({"rows": [row]}, {"rows": [row]}, 0.1).endswith("|  |\n"))


class Conditions(unittest.TestCase):
    def setUp(self):
        rng = np.random.default_rng(1)
        self.frames = [cv2.GaussianBlur(rng.integers(0, 255, (120, 160, 3)).astype(np.uint8), (9, 9), 3)
                       for _ in range(12)]

    def test_each_gives_images_of_one_size_with_frames_of_the_recording(self):
        for name, condition in CONDITIONS.items():
            with self.subTest(name):
                if condition.make is None:
                    continue
                made = list(condition.make(self.frames, 140.0))
                self.assertGreater(len(made), 0)
                self.assertEqual(len({image.shape for image, _ in made}), 1)
                for image, index in made:
                    self.assertEqual(image.dtype, np.uint8)
                    self.assertTrue(index is None or 0 <= index < len(self.frames))

    def test_rotations_become_quaternions(self):
        for axis in np.vstack([np.eye(3), [[0.6, 0.0, -0.8]]]):
            for angle in (0.0, 1e-9, 1.0, 2.5, np.pi):
                turn, _ = cv2.Rodrigues(angle * axis)
                expected = np.array([*(np.sin(angle / 2) * axis), np.cos(angle / 2)])
                self.assertGreater(abs(quaternion(turn) @ expected), 1 - 1e-12)

    def test_barrel_is_undone_by_its_own_calibration(self):
        bent, _ = next(iter(CONDITIONS["barrel"].make(self.frames, 140.0)))
        height, width = bent.shape[:2]
        camera = np.array([[140.0, 0, (width - 1) / 2], [0, 140.0, (height - 1) / 2], [0, 0, 1]])
        straight = cv2.undistort(bent, camera, np.array([*BARREL, 0, 0]))
        middle = self.frames[0][30:90, 40:120].astype(int)
        top, left = (120 - height) // 2, (160 - width) // 2
        difference = np.abs(straight[30 - top:90 - top, 40 - left:120 - left].astype(int) - middle)
        self.assertLess(difference.mean(), 3)


if __name__ == "__main__":
    unittest.main()
