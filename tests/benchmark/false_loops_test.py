# SPDX-License-Identifier: MIT
"""check_false_loops.py: two rooms that differ have no place in common, a room and itself have."""
import json
import sys
import tempfile
import unittest
from pathlib import Path

try:
    import cv2  # noqa: F401
    import numpy as np
except ImportError as problem:
    print(f"skipped: {problem}")
    sys.exit(0)

from project import PROGRAMS, run_tool  # noqa: E402
from check_false_loops import covering, pose_matrix, shared  # noqa: E402

ROOM = "synth --scene room --frames 90 --loops 0 --seed 4"


def run(folder, suite, *options):
    (folder / "suite.txt").write_text(suite)
    done = run_tool("check_false_loops.py", "--bin", PROGRAMS, "--suite", folder / "suite.txt", "--size", "320x240",
                    "--out", folder / "out", *options)
    table = folder / "out" / "false_loops.json"
    return done, json.loads(table.read_text()) if table.is_file() else None


class Program(unittest.TestCase):
    def test_a_room_that_is_taken_for_itself_counts_as_false(self):
        with tempfile.TemporaryDirectory() as folder:
            done, table = run(Path(folder), f"one {ROOM}\ntwo {ROOM}\ndesk synth --scene desk --frames 60\n", "--mixes")
            self.assertEqual(done.returncode, 1, done.stderr)
            rows = {row["mix"]: row for row in table["mixes"]}
            self.assertEqual(len(rows), 3)
            self.assertGreater(rows["one + two"]["posed"], 5)
            self.assertGreater(rows["one + two"]["accepted"], 0)
            for other in ("one + desk", "two + desk"):
                self.assertEqual((rows[other]["accepted"], rows[other]["posed"]), (0, 0))
            self.assertIn("3 mixes", done.stdout)

    def test_recordings_alone_are_judged_by_their_depth(self):
        with tempfile.TemporaryDirectory() as folder:
            done, table = run(Path(folder), "desk synth --scene desk --frames 60\n", "--alone")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual([row["recording"] for row in table["alone"]], ["desk"])
            self.assertLess(table["alone"][0]["ate_m"], 0.05)

    def test_refusals(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(run(Path(folder), "", "--size", "small")[0].returncode, 2)
            done, _ = run(Path(folder), "nothing /nowhere\n")
            self.assertEqual(done.returncode, 3)
            self.assertNotIn("Traceback", done.stderr)


class Geometry(unittest.TestCase):
    def test_cameras_share_what_both_see(self):
        wall, camera = np.full((240, 320), 2.0), (300.0, 300.0, 160.0, 120.0)
        here = (wall, camera, pose_matrix(np.array([0, 0, 0, 0, 0, 0, 1.0])))
        aside = (wall, camera, pose_matrix(np.array([320 / 300, 0, 0, 0, 0, 0, 1.0])))
        turned = (wall, camera, pose_matrix(np.array([0, 0, 0, 0, 1.0, 0, 0])))
        nearer = (wall - 1, camera, here[2])
        self.assertEqual(shared(here, here), 1.0)
        self.assertAlmostEqual(shared(here, aside), 0.5, delta=0.05)
        self.assertEqual(shared(here, turned), 0.0)
        self.assertEqual(shared(here, nearer), 0.0)

    def test_images_cover_the_size(self):
        for shape in ((960, 540, 3), (376, 1241, 3), (480, 640, 3)):
            self.assertEqual(covering(np.zeros(shape, np.uint8), (320, 240)).shape, (240, 320, 3))


if __name__ == "__main__":
    unittest.main()
