# SPDX-License-Identifier: MIT
"""Which keyframes the windows hold."""

import unittest

import setting  # noqa: F401
from contract.errors import ExportError
from recording.schedule import loop_window, windows


class Windows(unittest.TestCase):
    def test_neighbours_share_the_overlap(self):
        found = windows(30, 16, 2)
        self.assertEqual([(ids[0], ids[-1]) for ids in found], [(0, 15), (14, 29)])

    def test_what_is_left_at_the_end_gets_a_window(self):
        self.assertEqual(windows(33, 16, 2)[-1], [28, 29, 30, 31, 32])

    def test_one_keyframe_left_is_not_worth_a_window(self):
        self.assertEqual(len(windows(31, 16, 2)), 2)

    def test_a_short_recording_is_one_window(self):
        self.assertEqual(windows(5, 16, 2), [[0, 1, 2, 3, 4]])

    def test_an_overlap_as_large_as_the_window_is_refused(self):
        with self.assertRaises(ExportError):
            windows(30, 8, 8)

    def test_a_loop_takes_half_of_its_keyframes_around_each_place(self):
        self.assertEqual(loop_window(50, 10, 100, 8), [8, 9, 10, 11, 48, 49, 50, 51])

    def test_a_loop_at_the_ends_stays_inside(self):
        self.assertEqual(loop_window(19, 0, 20, 8), [0, 1, 2, 3, 16, 17, 18, 19])

    def test_a_loop_to_a_keyframe_that_is_not_there_is_refused(self):
        with self.assertRaises(ExportError):
            loop_window(20, 3, 20, 8)


if __name__ == "__main__":
    unittest.main()
