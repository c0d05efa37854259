# SPDX-License-Identifier: MIT
"""From the pixels of an image to a model's input, and its maps back: as drivers/onnx does it."""

import math
from dataclasses import dataclass

import numpy as np

from contract.card import ModelCard


@dataclass(frozen=True)
class Framing:
    """The image is resized to (height, width) and put at a whole offset into the input."""

    image_height: int
    image_width: int
    input_height: int
    input_width: int
    height: int
    width: int
    offset_y: int
    offset_x: int

    @property
    def scale_x(self) -> float:
        return self.width / self.image_width

    @property
    def scale_y(self) -> float:
        return self.height / self.image_height


def make_framing(card: ModelCard, input_height: int, input_width: int, image_height: int,
                 image_width: int) -> Framing:
    """`fit` stretches what differs by the rounding to the multiple only, and crops the rest."""
    sx, sy = input_width / image_width, input_height / image_height
    resize = card.resize
    if resize == "fit":
        half = 0.5 * card.multiple + 0.5
        rounding = (abs(sx * image_height - input_height) <= half or
                    abs(sy * image_width - input_width) <= half)
        resize = "stretch" if rounding else "crop"
    height, width = input_height, input_width
    if resize != "stretch":
        scale = max(sx, sy) if resize == "crop" else min(sx, sy)
        height = max(1, math.floor(scale * image_height + 0.5))
        width = max(1, math.floor(scale * image_width + 0.5))
    return Framing(image_height, image_width, input_height, input_width, height, width,
                   int((input_height - height) / 2), int((input_width - width) / 2))


def resampling_matrix(source: int, target: int) -> np.ndarray:
    """(target, source) weights of a triangle filter that widens when it shrinks."""
    step = source / target
    radius = max(step, 1.0)
    centers = (np.arange(target) + 0.5) * step
    weights = 1 - np.abs(np.arange(source) + 0.5 - centers[:, None]) / radius
    weights = np.maximum(weights, 0.0)
    return (weights / weights.sum(axis=1, keepdims=True)).astype(np.float32)


def _overlap(offset: int, inner: int, outer: int) -> slice:
    return slice(max(offset, 0), min(offset + inner, outer))


def preprocess(image: np.ndarray, framing: Framing, card: ModelCard) -> np.ndarray:
    """(3, H, W) float32 input, (x/255 - mean)/std, of an (h, w, 3) uint8 RGB image."""
    rows = resampling_matrix(framing.image_height, framing.height)
    columns = resampling_matrix(framing.image_width, framing.width)
    planes = rows @ image.astype(np.float32).transpose(2, 0, 1) @ columns.T
    padded = np.full((3, framing.input_height, framing.input_width), 255 * card.pad_value,
                     np.float32)
    y = _overlap(framing.offset_y, framing.height, framing.input_height)
    x = _overlap(framing.offset_x, framing.width, framing.input_width)
    padded[:, y, x] = planes[:, y.start - framing.offset_y:y.stop - framing.offset_y,
                             x.start - framing.offset_x:x.stop - framing.offset_x]
    mean = np.array(card.mean, np.float32).reshape(3, 1, 1)
    std = np.array(card.std, np.float32).reshape(3, 1, 1)
    return (padded / 255 - mean) / std


def to_image_grid(values: np.ndarray, framing: Framing, outside: float = 0.0) -> np.ndarray:
    """An input map (H, W) as one of the whole image in the resized size; `outside` of the input."""
    grid = np.full((framing.height, framing.width), outside, np.float32)
    y = _overlap(framing.offset_y, framing.height, framing.input_height)
    x = _overlap(framing.offset_x, framing.width, framing.input_width)
    grid[y.start - framing.offset_y:y.stop - framing.offset_y,
         x.start - framing.offset_x:x.stop - framing.offset_x] = values[y, x]
    return grid


def image_focal(intrinsics: np.ndarray, framing: Framing) -> float:
    """Geometric mean, in pixels of the image, of (V, 3, 3) matrices in pixels of the input."""
    fx = intrinsics[..., 0, 0].astype(np.float64) / framing.scale_x
    fy = intrinsics[..., 1, 1].astype(np.float64) / framing.scale_y
    return float(np.exp(np.mean(0.5 * np.log(fx * fy))))
