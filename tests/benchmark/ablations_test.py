# SPDX-License-Identifier: MIT
"""ablations.py on short simulated walks: its table, and what it refuses."""
import json
import subprocess
import tempfile
import unittest
from pathlib import Path

from project import PROGRAMS, run_tool


def run(*options):
    return run_tool("ablations.py", *options)


class Program(unittest.TestCase):
    def test_table(self):
        done = run("--programs", PROGRAMS, "--seeds", 1, "--keyframes", 64, "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        result = json.loads(done.stdout)
        self.assertEqual(result["protocol"]["seeds"], 1)
        ate = {(entry["row"], entry["overlap"]): entry["ate_m"] for entry in result["ablations"]}
        self.assertEqual(len(ate), 20)
        noise = {(entry["noise"], entry["sigma"]): entry["ate_m"] for entry in result["noise"]}
        self.assertEqual(noise["scale", 0.0], ate["full", 2])
        self.assertNotEqual(noise["scale", 0.15], ate["full", 2])
        for row, overlap in (("e2v", 0), ("bridge", 0), ("bridge", 2), ("tie", 2), ("scale", 2)):
            self.assertNotEqual(ate[row, overlap], ate["full", overlap], row)

    def test_text_has_protocol_and_paper(self):
        done = run("--programs", PROGRAMS, "--seeds", 1, "--keyframes", 64)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("alignment sim3", done.stdout.splitlines()[0])
        self.assertRegex(done.stdout, r"\| full \| 0\.\d{3} \| 0\.032 \| 0\.\d{3} \| 0\.020 \|")

    def test_recorded_predictions(self):
        replay, synth = Path(PROGRAMS) / "unisim-replay", Path(PROGRAMS) / "unisim-synth"
        if not replay.is_file() or not synth.is_file():
            self.skipTest("no unisim-replay or unisim-synth")
        with tempfile.TemporaryDirectory() as folder:
            room, recording = Path(folder) / "room", Path(folder) / "room.rec"
            subprocess.run([synth, room, "--scene", "room", "--frames", "90", "--size", "320x240", "--loops", "0"],
                           check=True, capture_output=True)
            subprocess.run([replay, room, "--stride", "3", "--record", recording, "--out", Path(folder) / "out", "--quiet",
                            "--no-report"], check=True, capture_output=True)
            done = run("--programs", PROGRAMS, "--recording", recording, "--sequence", room, "--json", "--",
                       "--stride", 3, "--ground-truth", room / "groundtruth.txt")
            self.assertEqual(done.returncode, 0, done.stderr)
            result = json.loads(done.stdout)
            ate = {entry["row"]: entry["ate_m"] for entry in result["ablations"]}
            self.assertEqual(len(ate), 10)
            self.assertEqual(result["noise"], [])
            self.assertNotEqual(ate["bridge"], ate["full"])
            self.assertNotEqual(ate["tracking only"], ate["full"])
            other = run("--programs", PROGRAMS, "--recording", recording, "--sequence", room, "--", "--stride", 5)
            self.assertEqual(other.returncode, 3)
            self.assertEqual(len(other.stderr.splitlines()), 1, other.stderr)

    def test_refusals(self):
        self.assertEqual(run("--recording", "a.rec").returncode, 2)
        self.assertEqual(run("--seeds", 0).returncode, 2)
        self.assertEqual(run("--", "--stride", 5).returncode, 2)
        missing = run("--programs", "/nowhere")
        self.assertEqual(missing.returncode, 3)
        self.assertIn("--programs", missing.stderr)
        self.assertEqual(len(missing.stderr.splitlines()), 1)


if __name__ == "__main__":
    unittest.main()
