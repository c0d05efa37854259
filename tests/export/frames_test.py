# SPDX-License-Identifier: MIT
"""Frames as record.py takes them: those that unisim-replay lists, with the pixels it sees."""

import os
import subprocess
import sys
import unittest
from pathlib import Path

import setting

setting.require("PIL")

import numpy as np  # noqa: E402
from PIL import Image  # noqa: E402

from contract.errors import ExportError  # noqa: E402
from recording.frames import Frame, list_frames  # noqa: E402
from recording.keyframes import SameSize, choose_keyframes  # noqa: E402
from recording.pixels import Unreadable, load_image, reader_of  # noqa: E402

PROGRAM = os.environ.get("UNISIM_REPLAY", "")
ORIENTATION = 0x0112


def corner(name: str) -> np.ndarray:
    """20x10, bright in the named corner."""
    image = np.zeros((10, 20, 3), np.uint8)
    image[:5 if "upper" in name else None, :10 if "left" in name else None] = 200
    return image


def write(path: Path, value: int = 100, size=(20, 10)) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    Image.new("RGB", size, (value,) * 3).save(path)


class Pixels(unittest.TestCase):
    def setUp(self):
        self.folder = setting.fresh_folder(self.addCleanup)

    def load(self, path: Path, **facts) -> np.ndarray:
        return load_image(Frame(0, 0, "images", str(path), **facts))

    def test_what_a_file_says_of_its_turning_counts_for_nothing(self):
        exif = Image.Exif()
        exif[ORIENTATION] = 6
        for ending in ("jpg", "png", "webp", "tif"):
            path = self.folder / f"a.{ending}"
            Image.fromarray(corner("upper left")).save(path, exif=exif)
            found = self.load(path)
            self.assertEqual(found.shape, (10, 20, 3), ending)
            self.assertGreater(found[1, 1, 0], 150, ending)
            self.assertLess(found[8, 18, 0], 50, ending)

    def test_the_orientation_of_the_sequence_turns_as_exif_says(self):
        path = self.folder / "a.png"
        Image.fromarray(corner("upper left")).save(path)
        corners = {1: (0, 0), 2: (0, -1), 3: (-1, -1), 4: (-1, 0), 5: (0, 0), 6: (0, -1),
                   7: (-1, -1), 8: (-1, 0)}
        for orientation, (row, column) in corners.items():
            found = self.load(path, orientation=orientation)
            self.assertEqual(found.shape[:2], (10, 20) if orientation < 5 else (20, 10))
            self.assertEqual(found[row, column, 0], 200, orientation)
            self.assertEqual(int(found[..., 0].sum()), 200 * 50)

    def test_the_bits_of_the_sequence_reduce_16_to_8(self):
        path = self.folder / "a.png"
        Image.fromarray(np.array([[2600, 160], [5000, 0]], np.uint16)).save(path)
        self.assertEqual(self.load(path, bits=12)[..., 0].tolist(), [[162, 10], [255, 0]])
        self.assertEqual(self.load(path)[..., 1].tolist(), [[10, 0], [19, 0]])

    def test_damaged_files_are_unreadable(self):
        good = self.folder / "good.jpg"
        write(good)
        data = good.read_bytes()
        broken = {"empty": b"", "cut.jpg": data[:len(data) // 2], "text.png": b"no image"}
        for name, content in broken.items():
            (self.folder / name).write_bytes(content)
            with self.assertRaisesRegex(Unreadable, name):
                self.load(self.folder / name)
        with self.assertRaisesRegex(Unreadable, "No such file"):
            self.load(self.folder / "none.png")


class Keyframes(unittest.TestCase):
    def setUp(self):
        self.folder = setting.fresh_folder(self.addCleanup)
        self.told = []

    def chosen(self, frames, stride):
        load = SameSize(reader_of(frames))
        return [frame.index for frame in choose_keyframes(frames, stride, load, self.told.append)]

    def frames(self, count):
        for k in range(count):
            write(self.folder / f"{k}.png")
        return [Frame(k, k, "images", str(self.folder / f"{k}.png")) for k in range(count)]

    def test_the_next_frame_of_the_cell_stands_in_for_an_unreadable_one(self):
        frames = self.frames(12)
        (self.folder / "4.png").write_bytes(b"")
        self.assertEqual(self.chosen(frames, 4), [0, 5, 8])
        self.assertEqual(len(self.told), 1)
        self.assertIn("frame 4: ", self.told[0])

    def test_the_first_readable_frame_begins_the_grid_and_sets_the_size(self):
        frames = self.frames(10)
        (self.folder / "0.png").unlink()
        write(self.folder / "4.png", size=(8, 8))
        self.assertEqual(self.chosen(frames, 3), [1, 5, 7])
        self.assertIn("is 8x8 but the sequence began with 20x10", self.told[1])


@unittest.skipUnless(PROGRAM, "skipped: no unisim-replay")
class Lists(unittest.TestCase):
    def setUp(self):
        self.folder = setting.fresh_folder(self.addCleanup)

    def names(self, sequence: Path, *arguments):
        return [Path(frame.path).name
                for frame in list_frames(str(sequence), *arguments, program=PROGRAM)]

    def test_lists_folders_and_ranges(self):
        for k in (2, 10, 1):
            write(self.folder / f"{k}.png")
        self.assertEqual(self.names(self.folder), ["1.png", "2.png", "10.png"])
        self.assertEqual(self.names(self.folder, 1, 2), ["2.png"])
        self.assertEqual(self.names(self.folder / "*0.png"), ["10.png"])

    def test_every_format_of_the_readers(self):
        root = self.folder
        write(root / "scene" / "seq-01" / "frame-000000.color.png")
        write(root / "kitti" / "image_2" / "000000.png")
        (root / "kitti" / "times.txt").write_text("0.5\n")
        write(root / "replica" / "results" / "frame000000.jpg")
        write(root / "euroc" / "mav0" / "cam0" / "data" / "7.png")
        (root / "euroc" / "mav0" / "cam0" / "data.csv").write_text("#t,name\n7,7.png\n")
        formats = [list_frames(str(root / name), program=PROGRAM)[0].format
                   for name in ("scene", "kitti", "replica", "euroc")]
        self.assertEqual(formats, ["7scenes", "kitti", "replica", "euroc"])

    def test_a_name_of_any_bytes_is_found(self):
        path = os.fsencode(self.folder) + b"/caf\xe9.png"
        write(self.folder / "a.png")
        os.rename(self.folder / "a.png", path)
        frame, = list_frames(str(self.folder), program=PROGRAM)
        self.assertEqual(os.fsencode(frame.path), path)
        self.assertEqual(load_image(frame).shape, (10, 20, 3))

    def test_what_the_sequence_needs_comes_with_the_frames(self):
        exif = Image.Exif()
        exif[ORIENTATION] = 6
        Image.fromarray(corner("upper left")).save(self.folder / "0.jpg", exif=exif)
        frame, = list_frames(str(self.folder), program=PROGRAM)
        self.assertEqual(frame.orientation, 6)
        self.assertEqual(load_image(frame).shape, (20, 10, 3))

    def test_its_refusals_are_passed_on(self):
        with self.assertRaisesRegex(ExportError, "no such folder or file") as caught:
            list_frames("/nowhere", program=PROGRAM)
        self.assertEqual(caught.exception.code, 3)

    def test_a_program_that_is_not_there_is_said(self):
        with self.assertRaisesRegex(ExportError, "/no/program: cannot be run"):
            list_frames("/nowhere", program="/no/program")

    def test_a_video_without_opencv_is_one_line(self):
        (self.folder / "cv2.py").write_text("raise ImportError('none here')")
        code = ("from recording.frames import Frame; from recording.pixels import VideoReader\n"
                "from contract.errors import run\n"
                "run('x', lambda: VideoReader()(Frame(0, 0, 'video', 'clip.mp4')))")
        found = subprocess.run([sys.executable, "-B", "-c", code], capture_output=True, text=True,
                               env={**os.environ,
                                    "PYTHONPATH": f"{self.folder}:{setting.TOOLS}"})
        self.assertIn("clip.mp4: a video needs OpenCV", found.stderr)
        self.assertEqual(found.stderr.count("\n"), 1)


if __name__ == "__main__":
    unittest.main()
