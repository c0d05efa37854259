# SPDX-License-Identifier: MIT
"""The metadata of every model, and which predictions are refused."""

import unittest
from dataclasses import replace
from pathlib import Path

import setting  # noqa: F401
import numpy as np
from contract.card import card_of, check_size, encoder_path, metadata, split_metadata
from contract.errors import BAD_USAGE, ExportError
from contract.validate import fault
from exporters.cards import CARDS, find_card
from exporters.options import exporter_module

EVERY_MODEL = {"contract", "kind", "model", "model_license", "height", "width", "multiple", "mean",
               "std", "resize", "pad_value", "exporter", "weights_sha256"}
GEOMETRY = {"min_views", "max_views", "confidence", "scale", "shared_scale", "reference_view",
            "pixel_center"}


class Metadata(unittest.TestCase):
    def test_every_model_says_all_that_the_contract_asks_for(self):
        for card in CARDS.values():
            keys = set(metadata(card, *card.size, "0"))
            asked = EVERY_MODEL | (set() if card.kind == "descriptor" else GEOMETRY)
            self.assertEqual(keys, {f"unisim.{key}" for key in asked}, card.name)

    def test_every_value_is_text_that_is_not_empty(self):
        for card in CARDS.values():
            for key, value in metadata(card, *card.size, "0").items():
                self.assertIsInstance(value, str, key)
                self.assertTrue(value, f"{card.name} {key}")

    def test_the_models_own_size_suits_its_patches(self):
        for card in CARDS.values():
            check_size(card, *card.size)

    def test_numbers_of_channels_are_three_with_blanks(self):
        self.assertEqual(metadata(find_card("da3-small"), 112, 154, "0")["unisim.mean"],
                         "0.485 0.456 0.406")

    def test_a_pair_model_takes_two_views(self):
        keys = metadata(find_card("sta"), 224, 224, "0")
        self.assertEqual((keys["unisim.min_views"], keys["unisim.max_views"]), ("2", "2"))

    def test_a_size_between_patches_is_refused_with_an_example(self):
        with self.assertRaisesRegex(ExportError, "multiples of 14, for example 224x308") as caught:
            check_size(find_card("da3-small"), 112, 150)
        self.assertEqual(caught.exception.code, BAD_USAGE)

    def test_an_unknown_model_is_refused_with_those_there_are(self):
        with self.assertRaisesRegex(ExportError, "da3-small"):
            find_card("da4")

    def test_a_missing_package_says_what_to_install(self):
        card = replace(find_card("pi3"), package="a_package_nobody_has")
        with self.assertRaisesRegex(ExportError, "checkout of github.com/yyfz/Pi3") as caught:
            exporter_module(card)
        self.assertEqual(caught.exception.code, BAD_USAGE)

    def test_a_file_says_of_its_input_what_the_card_said(self):
        for card in CARDS.values():
            keys = {key[len("unisim."):]: value
                    for key, value in metadata(card, 224, 448, "0").items()}
            found = card_of(keys, "x.onnx")
            self.assertEqual(found.size, (224, 448))
            for field in ("name", "kind", "mean", "std", "resize", "multiple", "confidence",
                          "scale", "license", "outputs", "input"):
                self.assertEqual(getattr(found, field), getattr(card, field), card.name)

    def test_a_file_without_a_key_is_refused_by_name(self):
        with self.assertRaisesRegex(ExportError, "x.onnx.*model_license"):
            card_of({"model": "m", "mean": "0 0 0", "std": "1 1 1", "kind": "pair"}, "x.onnx")

    def test_a_split_model_says_in_both_files_which_encoder_it_is(self):
        whole = metadata(find_card("sta"), 224, 224, "0")
        encoder, rest = split_metadata(whole, "1f")
        self.assertEqual(encoder["unisim.kind"], "encoder")
        self.assertEqual((rest["unisim.kind"], rest["unisim.input"]), ("pair", "features"))
        self.assertEqual((encoder["unisim.encoder"], rest["unisim.encoder"]), ("1f", "1f"))
        for key in EVERY_MODEL - {"kind"}:
            self.assertEqual(encoder[f"unisim.{key}"], rest[f"unisim.{key}"], key)
        self.assertFalse({f"unisim.{key}" for key in GEOMETRY} & set(encoder))

    def test_an_encoder_lies_beside_its_model(self):
        self.assertEqual(encoder_path(Path("a/sta.fp16.onnx")), Path("a/sta.fp16.encoder.onnx"))

    def test_a_card_with_a_word_the_runtime_does_not_know_cannot_be_made(self):
        with self.assertRaises(ValueError):
            replace(find_card("da3-small"), confidence="percent")


class Predictions(unittest.TestCase):
    def setUp(self):
        self.good = {"depth": np.ones((1, 2, 4, 4)), "confidence": np.ones((1, 2, 4, 4)),
                     "pose": np.tile(np.eye(3, 4), (1, 2, 1, 1)),
                     "intrinsics": np.tile(np.diag([100.0, 100, 1]), (1, 2, 1, 1))}

    def test_a_good_one_passes(self):
        self.assertIsNone(fault(self.good))

    def test_one_value_that_is_not_finite_names_its_output(self):
        self.good["pose"][0, 1, 0, 3] = np.nan
        self.assertIn("pose", fault(self.good))

    def test_one_depth_that_is_not_positive_is_refused(self):
        self.good["depth"][0, 0, 1, 2] = 0
        self.assertIn("depth", fault(self.good))

    def test_a_focal_length_of_zero_in_one_view_is_refused(self):
        self.good["intrinsics"][0, 1, 1, 1] = 0
        self.assertIn("focal", fault(self.good))


if __name__ == "__main__":
    unittest.main()
