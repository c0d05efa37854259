# SPDX-License-Identifier: MIT
"""The programs as a user sees them where no model is installed: exit codes and one line."""

import os
import subprocess
import sys
import unittest

import setting


def run(program: str, *arguments: str, path: str = "") -> subprocess.CompletedProcess:
    return subprocess.run([sys.executable, "-B", str(setting.TOOLS / program), *arguments],
                          capture_output=True, text=True, check=False,
                          env={**os.environ, "PYTHONPATH": path})


class Programs(unittest.TestCase):
    def refused(self, code: int, text: str, program: str, *arguments: str) -> None:
        result = run(program, *arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertIn(text, result.stderr)

    def test_the_list_names_the_licence_of_each_model(self):
        result = run("unisim_export.py", "list")
        self.assertEqual(result.returncode, 0)
        self.assertRegex(result.stdout, r"da3-small .*products: yes +Apache-2.0")
        self.assertRegex(result.stdout, r"vggt-omega .*products: no +FAIR Noncommercial")

    def test_an_unknown_model_is_bad_usage(self):
        self.refused(2, "da3-small", "unisim_export.py", "nothing", "--out", "x.onnx",
                     "--random-weights")

    def test_a_size_between_patches_is_bad_usage(self):
        self.refused(2, "multiples of 14", "unisim_export.py", "da3-small", "--out", "x.onnx",
                     "--size", "100x100", "--random-weights")

    def test_no_weights_says_where_they_are(self):
        self.refused(2, "DA3-SMALL", "unisim_export.py", "da3-small", "--out", "x.onnx")

    def test_a_model_that_cannot_be_split_says_why(self):
        self.refused(2, "attention across the views", "unisim_export.py", "da3-small", "--split",
                     "--out", "x.onnx", "--random-weights")

    def test_fp16_and_int8_at_once_is_bad_usage(self):
        result = run("unisim_export.py", "da3-small", "--fp16", "--int8", "--out", "x.onnx",
                     "--random-weights")
        self.assertEqual(result.returncode, 2)
        self.assertIn("not allowed with", result.stderr)

    def test_a_package_folder_that_is_not_there_is_bad_usage(self):
        self.refused(2, "no such folder", "unisim_export.py", "da3-small", "--out", "x.onnx",
                     "--random-weights", "--package-path", "/nowhere")

    @unittest.skipUnless(os.environ.get("UNISIM_REPLAY"), "skipped: no unisim-replay")
    def test_a_sequence_that_is_not_there_is_bad_input(self):
        self.refused(3, "/nowhere", "record.py", "da3-small", "/nowhere", "--out", "x.usr",
                     "--random-weights", "--unisim-replay", os.environ["UNISIM_REPLAY"])

    def test_without_numpy_every_program_says_so_in_one_line(self):
        folder = setting.fresh_folder(self.addCleanup)
        (folder / "numpy.py").write_text("raise ImportError('none here', name='numpy')")
        for program in sorted(path.name for path in setting.TOOLS.glob("*.py")):
            result = run(program, "info", path=str(folder))
            self.assertEqual(result.returncode, 2, program)
            self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
            self.assertIn("numpy is missing", result.stderr)


if __name__ == "__main__":
    unittest.main()
