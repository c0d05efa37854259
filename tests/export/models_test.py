# SPDX-License-Identifier: MIT
"""A published architecture from the command line to files that run: whole, fp16, int8, recorded.

Depth Anything 3 small stands for all: it is the one whose package installs with pip."""

import re
import subprocess
import sys
import unittest

import setting

setting.require("torch", "onnx", "onnxscript", "onnxruntime", "PIL", "depth_anything_3")
import numpy as np
from PIL import Image
from unisim_record import KEYFRAME, PAIR, WINDOW, read_header, read_records

MODEL = ["--random-weights", "--reduced"]
BOUNDS = {"float32": 1e-4, "fp16": 5e-2, "int8": 1.0}


def run(program: str, *arguments: str) -> str:
    result = subprocess.run([sys.executable, "-B", "-W", "ignore", str(setting.TOOLS / program),
                             *arguments], capture_output=True, text=True, check=False)
    if result.returncode != 0:
        raise AssertionError(f"{program} {' '.join(arguments)}: {result.stderr}")
    return result.stdout


def differences(text: str) -> dict:
    return {name: float(value)
            for name, value in re.findall(r"views +\d+ +(\w+) +max rel difference (\S+)", text)}


class Models(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = setting.fresh_folder(cls.addClassCleanup)
        cls.told = {}
        for kind in BOUNDS:
            more = [] if kind == "float32" else [f"--{kind}"]
            cls.told[kind] = run("unisim_export.py", "da3-small", "--out", cls.file(kind), "--size",
                                 "28x42", *MODEL, *more)

    @classmethod
    def file(cls, kind: str) -> str:
        return str(cls.folder / f"{kind}.onnx")

    def test_every_precision_runs_and_its_difference_is_told(self):
        for kind, bound in BOUNDS.items():
            checked = differences(run("unisim_export.py", "check", "da3-small", self.file(kind),
                                      *MODEL, "--views", "2,3", "--bound", str(bound)))
            self.assertEqual(set(checked), {"depth", "confidence", "pose", "intrinsics"})
            self.assertLess(max(checked.values()), bound, kind)
            if kind != "float32":
                self.assertIn(f"{kind} against float32", self.told[kind])
                self.assertGreater(max(differences(self.told[kind]).values()), 1e-5, kind)

    def test_torch_and_the_exported_file_record_the_same(self):
        sequence = self.folder / "sequence"
        sequence.mkdir()
        shades = np.random.default_rng(0)
        for k in range(4):
            coarse = shades.integers(0, 255, (7, 9, 3), np.uint8)
            Image.fromarray(coarse).resize((64, 48)).save(sequence / f"{k}.png")
        by_torch, by_file = str(self.folder / "torch.usr"), str(self.folder / "file.usr")
        run("record.py", "da3-small", str(sequence), "--out", by_torch, "--size", "28x42",
            "--stride", "1", *MODEL)
        run("record.py", self.file("float32"), str(sequence), "--out", by_file, "--stride", "1")
        first, second = self.records(by_torch), self.records(by_file)
        self.assertEqual([kind for kind, _ in first],
                         [KEYFRAME] * 4 + [PAIR, PAIR, PAIR, WINDOW])
        self.assertEqual([kind for kind, _ in first], [kind for kind, _ in second])
        for (kind, a), (_, b) in zip(first, second):
            if kind == PAIR:  # focal length, center_sigma, quaternion, translation, scale
                a, b = np.frombuffer(a[:80], "<f8"), np.frombuffer(b[:80], "<f8")
                np.testing.assert_allclose(a, b, rtol=1e-4, atol=1e-5)

    @staticmethod
    def records(path: str) -> list:
        with open(path, "rb") as file:
            read_header(file)
            return [(kind, data) for _, kind, _, data in read_records(file)
                    if kind in (KEYFRAME, PAIR, WINDOW)]


if __name__ == "__main__":
    unittest.main()
