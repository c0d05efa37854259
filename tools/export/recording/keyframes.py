# SPDX-License-Identifier: MIT
"""Which frames are keyframes, as `unisim-replay --stride` chooses them."""

from typing import Callable, List, Optional, Tuple

import numpy as np

from recording.frames import Frame
from recording.pixels import Unreadable


def size_text(image: np.ndarray) -> str:
    return f"{image.shape[1]}x{image.shape[0]}"


class SameSize:
    """Loads frames; one that differs in size from the first is as unreadable as a damaged one."""

    def __init__(self, load: Callable[[Frame], np.ndarray]):
        self._load = load
        self.shape: Optional[Tuple[int, ...]] = None

    def __call__(self, frame: Frame) -> np.ndarray:
        image = self._load(frame)
        if self.shape is None:
            self.shape = image.shape
        if image.shape != self.shape:
            raise Unreadable(f"{frame.path}: is {size_text(image)} but the sequence began with "
                             f"{self.shape[1]}x{self.shape[0]}")
        return image


def choose_keyframes(frames: List[Frame], stride: int, load: Callable[[Frame], np.ndarray],
                     tell: Callable[[str], None]) -> List[Frame]:
    """Every `stride`-th frame of the grid that the first one begins. The next frame of the cell
    stands in for one that cannot be loaded, which is told."""
    chosen: List[Frame] = []
    for frame in frames:
        if chosen:
            first, last = chosen[0].index, chosen[-1].index
            if (frame.index - first) // stride <= (last - first) // stride:
                continue
        try:
            load(frame)
        except Unreadable as error:
            tell(f"frame {frame.index}: {error}: skipped")
        else:
            chosen.append(frame)
    return chosen
