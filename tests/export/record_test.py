# SPDX-License-Identifier: MIT
"""Predictions as they are written: the same numbers that drivers/onnx hands to a session."""

import struct
import tempfile
import unittest
from dataclasses import replace
from pathlib import Path

import setting  # noqa: F401
import numpy as np
from contract.quantile import quantiles
from exporters.cards import find_card
from recording.predictor import Predictor, Rejected
from record import write_window
from unisim_record import PAIR, WINDOW, RecordWriter, read_header, read_records

CARD = find_card("sta")
SIDE = 32


def turn_about_y(angle: float) -> np.ndarray:
    return np.array([[np.cos(angle), 0, np.sin(angle), 0.1], [0, 1, 0, 0.2],
                     [-np.sin(angle), 0, np.cos(angle), 0.3]])


class Model:
    """Answers with what it was made with."""

    def __init__(self, **changed):
        flat = np.ones((1, 2, SIDE, SIDE), np.float32)
        focal = np.array([100.0, 400.0], np.float32)
        intrinsics = np.stack([np.diag([f, f, 1]) for f in focal])[None]
        self.outputs = {"depth": flat, "confidence": flat, "intrinsics": intrinsics,
                        "pose": np.tile(np.eye(3, 4), (1, 2, 1, 1)),
                        "pose_confidence": np.ones((1, 2), np.float32), **changed}

    def run(self, values):
        self.given = values
        return self.outputs


def predictor(model: Model, size=(SIDE, SIDE), **options) -> Predictor:
    return Predictor(model, CARD, (SIDE, SIDE), size,
                     lambda k: np.full((*size, 3), k, np.uint8), **options)


class Quaternions(unittest.TestCase):
    def written(self, T_0_1: np.ndarray) -> np.ndarray:
        """The quaternion x y z w of a pair in a file."""
        with tempfile.TemporaryDirectory() as folder:
            path = str(Path(folder) / "pair.usr")
            flat = np.ones((2, 2), np.float32)
            with RecordWriter(path) as record:
                record.keyframe(0, 0)
                record.keyframe(1, 5)
                record.pair(0, 1, T_0_1, flat, flat)
            with open(path, "rb") as file:
                read_header(file)
                data, = [data for _, kind, _, data in read_records(file) if kind == PAIR]
        return np.array(struct.unpack("<4d", data[16:48]))

    def test_of_the_two_that_are_one_rotation_the_one_with_positive_w_is_written(self):
        for angle in np.linspace(-3.1, 3.1, 63):
            expected = [0, np.sin(angle / 2), 0, np.cos(angle / 2)]
            np.testing.assert_allclose(self.written(turn_about_y(angle)), expected, atol=1e-12)


class Units(unittest.TestCase):
    def test_the_windows_of_a_metric_model_say_that_they_are_in_metres(self):
        for scale, end in (("metric", (1.0, 0.1, 0.05)), ("relative", None)):
            model = Predictor(Model(), replace(CARD, scale=scale), (SIDE, SIDE), (SIDE, SIDE),
                              lambda k: np.full((SIDE, SIDE, 3), k, np.uint8))
            with tempfile.TemporaryDirectory() as folder:
                path = str(Path(folder) / "window.usr")
                with RecordWriter(path) as record:
                    write_window(record, model, [0, 1])
                with open(path, "rb") as file:
                    read_header(file)
                    data, = [data for _, kind, _, data in read_records(file) if kind == WINDOW]
            self.assertEqual(model.unit, end)
            if end is not None:
                self.assertEqual(struct.unpack("<3d", data[-24:]), end)


class Predictions(unittest.TestCase):
    def test_confidence_is_its_rank_and_equal_values_share_theirs(self):
        np.testing.assert_allclose(quantiles(np.array([[5.0, -1.0], [7.0, 5.0]])),
                                   [[0.5, 0.0], [1.0, 0.5]])

    def test_what_a_crop_hides_is_least_confident_and_has_no_depth(self):
        confidence = np.random.default_rng(0).random((1, 2, SIDE, SIDE)).astype(np.float32)
        found = predictor(Model(confidence=confidence), size=(SIDE, 2 * SIDE)).predict([0, 1])
        seen = found.depths[0] > 0
        self.assertEqual(seen.mean(), 0.5)
        self.assertLessEqual(found.confidences[0][~seen].max(), found.confidences[0][seen].min())

    def test_the_focal_length_is_the_geometric_mean_of_the_views(self):
        self.assertAlmostEqual(predictor(Model()).predict([0, 1]).focal_px, 200.0, places=4)

    def test_a_pose_that_the_model_is_not_sure_of_is_rejected(self):
        unsure = Model(pose_confidence=np.array([[0.9, 0.7]], np.float32))
        with self.assertRaisesRegex(Rejected, "pose confidence 0.7 is below 0.75"):
            predictor(unsure).predict([0, 1])
        predictor(unsure, min_pose_confidence=0.5).predict([0, 1])

    def test_one_pixel_without_depth_rejects_the_prediction(self):
        depth = np.ones((1, 2, SIDE, SIDE), np.float32)
        depth[0, 1, 3, 4] = 0
        with self.assertRaisesRegex(Rejected, "depth 0 is not above 0"):
            predictor(Model(depth=depth)).predict([0, 1])

    def test_a_keyframe_is_loaded_once(self):
        loads = []
        asked = Predictor(Model(), CARD, (SIDE, SIDE), (SIDE, SIDE),
                          lambda k: loads.append(k) or np.zeros((SIDE, SIDE, 3), np.uint8))
        asked.predict([0, 1])
        asked.predict([1, 2])
        self.assertEqual(loads, [0, 1, 2])


if __name__ == "__main__":
    unittest.main()
