# SPDX-License-Identifier: MIT
"""A model asked for pairs and windows, as the runtime asks it: images in, poses and depth out."""

from dataclasses import dataclass
from typing import Callable, List, Sequence, Tuple

import numpy as np

from contract.card import ModelCard
from contract.framing import Framing, image_focal, make_framing, preprocess, to_image_grid
from contract.poses import reanchor
from contract.quantile import quantiles
from contract.validate import MIN_POSE_CONFIDENCE, fault
from recording.pixels import Unreadable


# Of a model that predicts metres: relative standard deviation of a window, and of all together, as
# drivers/onnx takes them.
METRIC_SIGMA = 0.1
METRIC_COMMON_SIGMA = 0.05


class Rejected(Exception):
    """The prediction cannot be used; the text says why, in one line."""


@dataclass(frozen=True)
class Prediction:
    """Of V views: poses T_0_i (V, 3, 4), depth and confidence maps of the whole image, and one
    focal length in pixels of the image. Depth is 0 where the model sees nothing, confidence is
    its quantile in the view."""

    poses: np.ndarray
    depths: List[np.ndarray]
    confidences: List[np.ndarray]
    focal_px: float


class Predictor:
    """Keeps the inputs of the keyframes, so that an image is decoded and resized once."""

    def __init__(self, runner, card: ModelCard, input_size: Tuple[int, int],
                 image_size: Tuple[int, int], load: Callable[[int], np.ndarray],
                 min_pose_confidence: float = MIN_POSE_CONFIDENCE):
        self._runner = runner
        self._card = card
        self.framing: Framing = make_framing(card, *input_size, *image_size)
        self._load = load
        self._min_pose_confidence = min_pose_confidence
        self._inputs = {}
        metric = card.scale == "metric"
        self.unit = (1.0, METRIC_SIGMA, METRIC_COMMON_SIGMA) if metric else None

    def forget_before(self, keyframe: int) -> None:
        self._inputs = {k: value for k, value in self._inputs.items() if k >= keyframe}

    def _input(self, keyframe: int) -> np.ndarray:
        if keyframe not in self._inputs:
            self._inputs[keyframe] = preprocess(self._load(keyframe), self.framing, self._card)
        return self._inputs[keyframe]

    def predict(self, keyframes: Sequence[int]) -> Prediction:
        try:
            inputs = np.stack([self._input(k) for k in keyframes])[None]
        except Unreadable as error:  # it could be read when the keyframes were chosen
            raise Rejected(str(error)) from error
        outputs = self._runner.run(inputs)
        wrong = fault(outputs, self._min_pose_confidence)
        if wrong:
            raise Rejected(f"{self._card.name}: {wrong}")
        depths = [to_image_grid(depth, self.framing) for depth in outputs["depth"][0]]
        confidences = [quantiles(to_image_grid(value, self.framing, value.min()))
                       for value in outputs["confidence"][0]]
        return Prediction(reanchor(outputs["pose"][0]), depths, confidences,
                          image_focal(outputs["intrinsics"][0], self.framing))
