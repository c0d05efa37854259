# SPDX-License-Identifier: MIT
"""Pixels of a frame as `unisim-replay` sees them: turned, reduced to 8 bits, stretched."""

import io
import os
from pathlib import Path
from typing import Callable, Optional

import numpy as np

from contract.errors import BAD_USAGE, ExportError
from recording.frames import Frame

_TAIL = 1024  # some writers append a few bytes after the end mark
_END_MARKS = {b"\xff\xd8": b"\xff\xd9", b"\x89P": b"IEND"}
_ORIENTATION = 0x0112
_DEEP_MODES = ("I;16", "I;16B", "I;16L", "I;16N", "I")


class Unreadable(Exception):
    """A frame without pixels; the text says which and why."""


def _opencv(what: str):
    try:
        os.environ.setdefault("OPENCV_FFMPEG_LOGLEVEL", "-8")
        import cv2
    except ImportError as error:
        raise ExportError(f"{what} needs OpenCV: pip install opencv-python-headless; or write "
                          "images with: ffmpeg -i FILE FOLDER/%06d.png", BAD_USAGE) from error
    return cv2


def _reduced(deep: np.ndarray, bits: int) -> np.ndarray:
    """16-bit pixels to 8 bits; what is beyond `bits` is white."""
    return np.minimum(deep.astype(np.uint16) >> (bits - 8), 255).astype(np.uint8)


def upright(image: np.ndarray, orientation: int) -> np.ndarray:
    """The picture turned as EXIF says for 1 to 8."""
    if orientation >= 5:
        image = image.swapaxes(0, 1)
    flips = {2: np.s_[:, ::-1], 3: np.s_[::-1, ::-1], 4: np.s_[::-1],
             6: np.s_[:, ::-1], 7: np.s_[::-1, ::-1], 8: np.s_[::-1]}
    return np.ascontiguousarray(image[flips[orientation]] if orientation in flips else image)


def _without_turn(data: bytes) -> bytes:
    """A TIFF file whose orientation is 1, so that no reader turns it by itself."""
    order = {b"II*\0": "little", b"MM\0*": "big"}.get(data[:4])
    if order is None:
        return data

    def number(at: int, size: int) -> int:
        return int.from_bytes(data[at:at + size], order)

    directory = number(4, 4)
    for k in range(number(directory, 2)):
        field = directory + 2 + 12 * k
        if number(field, 2) == _ORIENTATION:
            return data[:field + 8] + (1).to_bytes(2, order) + data[field + 10:]
    return data


def _read_file(path: str) -> bytes:
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        raise Unreadable(f"{path}: cannot be read: {error.strerror}") from error
    if not data:
        raise Unreadable(f"{path}: is empty")
    end = _END_MARKS.get(data[:2])
    if end is not None and end not in data[-_TAIL:]:
        raise Unreadable(f"{path}: is truncated")
    return data


def _deep_colour(path: str, data: bytes) -> np.ndarray:
    """Pillow keeps 8 of 16 bits of colour images."""
    cv2 = _opencv(f"{path}: a colour image of 16 bits that are not all used")
    flags = cv2.IMREAD_ANYCOLOR | cv2.IMREAD_ANYDEPTH | cv2.IMREAD_IGNORE_ORIENTATION
    image = cv2.imdecode(np.frombuffer(data, np.uint8), flags)
    if image is None or image.ndim != 3:
        raise Unreadable(f"{path}: is not an image that can be decoded")
    return image[..., ::-1]


def load_image(frame: Frame) -> np.ndarray:
    """(h, w, 3) uint8 RGB."""
    from PIL import Image
    Image.MAX_IMAGE_PIXELS = None  # no web server's limit for a camera's pictures
    data = _without_turn(_read_file(frame.path))
    try:
        with Image.open(io.BytesIO(data)) as image:
            if image.mode in _DEEP_MODES:
                pixels = _reduced(np.asarray(image), frame.bits)
                pixels = np.repeat(pixels[..., None], 3, axis=2)
            elif frame.bits < 16 and image.mode == "RGB":
                pixels = _deep_colour(frame.path, data)
                pixels = _reduced(pixels, frame.bits) if pixels.dtype == np.uint16 else pixels
            else:
                pixels = np.asarray(image.convert("RGB"))
    except (OSError, SyntaxError, ValueError) as error:  # what Pillow raises on damaged files
        raise Unreadable(f"{frame.path}: is not an image that can be decoded") from error
    return upright(pixels, frame.orientation)


class VideoReader:
    """Frames of a video by growing index; going back opens the file again."""

    def __init__(self) -> None:
        self._video = None
        self._path = ""
        self._grabbed = 0

    def __call__(self, frame: Frame) -> np.ndarray:
        cv2 = _opencv(f"{frame.path}: a video")
        if self._video is None or frame.index < self._grabbed:
            self._video = cv2.VideoCapture(frame.path, cv2.CAP_FFMPEG)
            self._grabbed = 0
            if self._video.get(cv2.CAP_PROP_ORIENTATION_META) % 360 != 0:
                # Releases of OpenCV turn such videos in different directions.
                raise ExportError(f"{frame.path}: a video of a turned camera: write images with: "
                                  "ffmpeg -i FILE FOLDER/%06d.png")
        image: Optional[np.ndarray] = None
        while self._grabbed <= frame.index and self._video.grab():
            self._grabbed += 1
        if self._grabbed == frame.index + 1:
            image = self._video.retrieve()[1]
        if image is None:
            raise Unreadable(f"{frame.path}: frame {frame.index} cannot be decoded")
        if frame.stretched is not None:
            smaller = np.prod(frame.stretched) < np.prod(image.shape[:2])
            image = cv2.resize(image, frame.stretched,
                               interpolation=cv2.INTER_AREA if smaller else cv2.INTER_LINEAR)
        return np.ascontiguousarray(image[..., ::-1])


def reader_of(frames: list) -> Callable[[Frame], np.ndarray]:
    """What loads the pixels of these frames."""
    return VideoReader() if frames[0].format == "video" else load_image
