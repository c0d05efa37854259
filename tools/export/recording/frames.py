# SPDX-License-Identifier: MIT
"""Frames of a recorded sequence, numbered as `unisim-replay` numbers them."""

import re
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation
from pathlib import Path
from typing import List, Optional

import numpy as np

from contract.errors import ExportError

UNKNOWN_TIME = -(2**63)
_ENDINGS = (".png", ".jpg", ".jpeg", ".bmp", ".pgm", ".ppm", ".tif", ".tiff", ".webp")


@dataclass(frozen=True)
class Frame:
    path: Path
    timestamp_ns: int = UNKNOWN_TIME


def _natural(path: Path) -> list:
    parts = re.split(r"(\d+)", path.name)
    return [int(part) if part.isdigit() else part for part in parts]


def _seconds(text: str) -> Optional[int]:
    """Nanoseconds of a decimal number of seconds, without the rounding of a float."""
    try:
        return int((Decimal(text) * 1_000_000_000).to_integral_value())
    except InvalidOperation:
        return None


def _tum(folder: Path) -> List[Frame]:
    frames = []
    for line in (folder / "rgb.txt").read_text().splitlines():
        fields = line.split(None, 1)
        time_ns = _seconds(fields[0]) if len(fields) == 2 else None
        if time_ns is not None:
            frames.append(Frame(folder / fields[1].strip(), time_ns))
    return frames


def list_frames(folder: Path) -> List[Frame]:
    """TUM RGB-D (rgb.txt), 7-Scenes (frame-*.color.*), or a folder of images in natural order."""
    if not folder.is_dir():
        raise ExportError(f"{folder}: no such folder; give that of the sequence")
    if (folder / "rgb.txt").is_file():
        frames = _tum(folder)
    else:
        images = [path for path in folder.iterdir() if path.suffix.lower() in _ENDINGS]
        colour = [path for path in images if re.match(r"frame-\d+\.color\.", path.name)]
        frames = [Frame(path) for path in sorted(colour or images, key=_natural)]
    if not frames:
        raise ExportError(f"{folder}: no rgb.txt, no frame-*.color.* and no images; give the folder "
                          "that has them")
    return frames


def load(path: Path) -> np.ndarray:
    """(h, w, 3) uint8 RGB."""
    from PIL import Image, UnidentifiedImageError
    try:
        with Image.open(path) as image:
            return np.asarray(image.convert("RGB"))
    except (OSError, UnidentifiedImageError) as error:
        raise ExportError(f"{path}: cannot be read as an image: {error}") from error
