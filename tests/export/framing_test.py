# SPDX-License-Identifier: MIT
"""Images into a model's input and its maps back."""

import unittest
from dataclasses import replace

import setting  # noqa: F401
import numpy as np
from contract.framing import (image_focal, make_framing, preprocess, resampling_matrix,
                              to_image_grid)
from exporters.cards import find_card

CARD = find_card("da3-small")
PLAIN = replace(CARD, mean=(0.0, 0.0, 0.0), std=(1.0, 1.0, 1.0))


class Framings(unittest.TestCase):
    def test_fit_stretches_what_differs_by_rounding_only(self):
        framing = make_framing(CARD, 112, 154, 240, 320)  # 112 / 240 * 320 = 149.3, rounds to 154
        self.assertEqual((framing.height, framing.width), (112, 154))
        self.assertEqual((framing.offset_y, framing.offset_x), (0, 0))

    def test_fit_crops_another_aspect_in_the_middle(self):
        framing = make_framing(CARD, 224, 224, 240, 480)
        self.assertEqual((framing.height, framing.width), (224, 448))
        self.assertEqual((framing.offset_y, framing.offset_x), (0, -112))

    def test_pad_shows_the_whole_image(self):
        framing = make_framing(replace(CARD, resize="pad"), 224, 224, 240, 480)
        self.assertEqual((framing.height, framing.width), (112, 224))
        self.assertEqual((framing.offset_y, framing.offset_x), (56, 0))

    def test_the_focal_length_is_that_of_the_image(self):
        framing = make_framing(replace(CARD, resize="crop"), 224, 224, 240, 480)
        intrinsics = np.array([[[140.0, 0, 112], [0, 140.0, 112], [0, 0, 1]]])
        self.assertAlmostEqual(image_focal(intrinsics, framing), 150.0)


class Pixels(unittest.TestCase):
    def test_a_flat_image_stays_flat_and_is_normalised(self):
        image = np.full((240, 320, 3), 51, np.uint8)
        values = preprocess(image, make_framing(CARD, 112, 154, 240, 320), CARD)
        self.assertEqual(values.shape, (3, 112, 154))
        for channel in range(3):
            expected = (0.2 - CARD.mean[channel]) / CARD.std[channel]
            np.testing.assert_allclose(values[channel], expected, atol=1e-5)

    def test_channels_keep_their_order(self):
        image = np.zeros((28, 28, 3), np.uint8)
        image[..., 0] = 255
        values = preprocess(image, make_framing(PLAIN, 28, 28, 28, 28), PLAIN)
        np.testing.assert_allclose(values.mean(axis=(1, 2)), [1, 0, 0], atol=1e-6)

    def test_a_padded_border_is_black(self):
        card = replace(PLAIN, resize="pad")
        framing = make_framing(card, 28, 28, 14, 28)
        values = preprocess(np.full((14, 28, 3), 255, np.uint8), framing, card)
        np.testing.assert_allclose(values[:, 7:21], 1, atol=1e-6)
        self.assertEqual(values[:, :7].max(), 0)
        self.assertEqual(values[:, 21:].max(), 0)

    def test_shrinking_averages_all_pixels_with_equal_weight(self):
        weights = resampling_matrix(40, 10)
        np.testing.assert_allclose(weights.sum(axis=1), 1, atol=1e-6)
        np.testing.assert_allclose(weights.sum(axis=0)[6:-6], 0.25, atol=1e-6)

    def test_equal_sizes_change_nothing(self):
        np.testing.assert_allclose(resampling_matrix(9, 9), np.eye(9), atol=1e-7)


class Maps(unittest.TestCase):
    def test_what_a_crop_did_not_see_has_no_depth(self):
        framing = make_framing(replace(CARD, resize="crop"), 28, 28, 28, 56)
        grid = to_image_grid(np.ones((28, 28)), framing)
        self.assertEqual(grid.shape, (28, 56))
        self.assertEqual(grid[:, 14:42].min(), 1)
        self.assertEqual(grid[:, :14].max(), 0)
        self.assertEqual(grid[:, 42:].max(), 0)

    def test_a_padded_border_is_cut_off(self):
        framing = make_framing(replace(CARD, resize="pad"), 28, 28, 14, 28)
        values = np.zeros((28, 28))
        values[7:21] = 3
        grid = to_image_grid(values, framing)
        self.assertEqual(grid.shape, (14, 28))
        self.assertEqual(grid.min(), 3)


if __name__ == "__main__":
    unittest.main()
