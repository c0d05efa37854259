# SPDX-License-Identifier: MIT
"""Hard conditions for benchmark.py: each makes of a recording one that is worse in one respect.

What a condition makes are pairs (image, index): BGR pixels and the frame of the recording whose pose they have,
None where no pose is to be compared. One that makes nothing takes the recording as it is. Frames follow each other at
the recording's own rate unless it says else. Sizes in pixels are of a 640 pixel wide image and scale with the width.
The seeds are fixed: the same recording gives the same images.
"""
from dataclasses import dataclass, field
from typing import Callable, Optional

import cv2
import numpy as np

BARREL = (-0.3, 0.08)  # OpenCV's k1, k2: a wide action camera
BORDER = 0.05          # of each side, cut off where the warped image has no content


@dataclass
class Condition:
    text: str
    make: Optional[Callable] = None
    quality: int = 92             # of the JPEG files
    every: int = 1                # frames of the recording from one image to the next
    focal: float = 1.0            # of the images over that of the recording
    given: Callable = field(default=lambda focal: [])  # what unisim-replay is told of the camera
    needs_focal: bool = False     # a true one


def clipped(pixels):
    return np.clip(pixels, 0, 255).astype(np.uint8)


def plain(frames, _focal):
    for i in range(len(frames)):
        yield frames[i], i


def half(frames, _focal):
    for i in range(len(frames)):
        image = frames[i]
        yield cv2.resize(image, (image.shape[1] // 2, image.shape[0] // 2), interpolation=cv2.INTER_AREA), i


def every_fifth(frames, _focal):
    for i in range(0, len(frames), 5):
        yield frames[i], i


def flicker(frames, _focal):
    """Gain and gamma, each with a deviation of 25 % from frame to frame."""
    rng = np.random.default_rng(7)
    for i in range(len(frames)):
        gain = np.clip(1 + 0.25 * rng.standard_normal(), 0.5, 1.6)
        gamma = np.clip(1 + 0.25 * rng.standard_normal(), 0.6, 1.6)
        yield clipped(255 * np.power(frames[i] / 255.0, gamma) * gain), i


def shift_to_next(frames, i):
    """How far the image as a whole moves to the next one: pixels, right and down."""
    small = [cv2.cvtColor(cv2.resize(frames[min(k, len(frames) - 1)], (160, 120)), cv2.COLOR_BGR2GRAY)
             .astype(np.float32) for k in (i, i + 1)]
    (right, down), _ = cv2.phaseCorrelate(*small)
    height, width = frames[i].shape[:2]
    shift = np.array([right * width / 160, down * height / 120])
    return shift if np.abs(shift).max() < 0.1 * width else np.zeros(2)


def blur(frames, _focal):
    """A shutter open for 90 % of the time to the next frame."""
    for i in range(len(frames)):
        reach = 20 * max(1, frames[i].shape[1] // 640)
        shift = 0.9 * shift_to_next(frames, i)
        kernel = np.zeros((2 * reach + 1, 2 * reach + 1), np.float32)
        for part in np.linspace(-0.5, 0.5, 81):
            x, y = np.clip(np.round(part * shift).astype(int), -reach, reach)
            kernel[reach + y, reach + x] += 1
        yield cv2.filter2D(frames[i], -1, kernel / kernel.sum()), i


def noise(frames, _focal):
    rng = np.random.default_rng(7)
    for i in range(len(frames)):
        yield clipped(frames[i] + rng.normal(0, 12, frames[i].shape)), i


def barrel(frames, focal):
    height, width = frames[0].shape[:2]
    center = np.array([(width - 1) / 2, (height - 1) / 2])
    pixels = np.stack(np.meshgrid(np.arange(width), np.arange(height)), -1).reshape(-1, 1, 2).astype(np.float64)
    camera = np.array([[focal, 0, center[0]], [0, focal, center[1]], [0, 0, 1]])
    rays = cv2.undistortPointsIter(pixels, camera, np.array([*BARREL, 0, 0]), None, None,
                                   (cv2.TERM_CRITERIA_COUNT, 50, 0))
    places = (rays.reshape(height, width, 2) * focal + center).astype(np.float32)
    top, left = round(BORDER * height), round(BORDER * width)
    for i in range(len(frames)):
        bent = cv2.remap(frames[i], places, None, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REFLECT)
        yield bent[top:height - top, left:width - left], i


def crop(frames, _focal):
    for i in range(len(frames)):
        height, width = frames[i].shape[:2]
        rows = min(height, round(width * 9 / 16))
        top = (height - rows) // 2
        yield frames[i][top:top + rows], i


def occluder(frames, _focal):
    """A person-sized thing walks through the image, two thirds of the time."""
    rng = np.random.default_rng(7)
    height, width = frames[0].shape[:2]
    across = round(0.4 * width)
    pattern = cv2.resize(rng.integers(0, 255, (60, 26, 3)).astype(np.uint8), (across, height),
                         interpolation=cv2.INTER_CUBIC)
    for i in range(len(frames)):
        image, step = frames[i].copy(), i % 150
        x = round(-across + 0.014 * width * step)
        y = round(0.04 * height + 0.02 * height * np.sin(i / 5))
        left, right = max(0, x), min(width, x + across)
        if step < 100 and right > left:
            image[y:, left:right] = pattern[:height - y, left - x:right - x]
        yield image, i


def rolling(frames, _focal):
    """Rows read out one after the other over 80 % of the frame time."""
    for i in range(len(frames)):
        right, down = shift_to_next(frames, i)
        height, width = frames[i].shape[:2]
        x, y = np.meshgrid(np.arange(width, dtype=np.float32), np.arange(height, dtype=np.float32))
        part = (y / height - 0.5) * 0.8
        yield cv2.remap(frames[i], (x - part * right).astype(np.float32), (y - part * down).astype(np.float32),
                        cv2.INTER_LINEAR, borderMode=cv2.BORDER_REFLECT), i


def rotation(frames, focal):
    """Three fifths in, the camera turns 30 degrees on the spot and back, 60 frames long."""
    rng = np.random.default_rng(7)
    height, width = frames[0].shape[:2]
    camera = np.array([[focal, 0, (width - 1) / 2], [0, focal, (height - 1) / 2], [0, 0, 1]])
    at = len(frames) * 3 // 5
    for i in range(len(frames)):
        yield frames[i], i
        for step in range(1, 60) if i == at else ():
            turn, _ = cv2.Rodrigues(np.array([0, np.deg2rad(30 * np.sin(np.pi * step / 60)), 0]))
            warped = cv2.warpPerspective(frames[i], camera @ turn @ np.linalg.inv(camera), (width, height),
                                         borderMode=cv2.BORDER_REFLECT)
            yield clipped(warped + rng.normal(0, 2, warped.shape)), None


def black(frames, _focal):
    """60 frames in the middle are dark but for the sensor's noise."""
    rng = np.random.default_rng(7)
    begin = len(frames) // 2
    for i in range(len(frames)):
        if begin <= i < begin + 60:
            yield rng.integers(4, 8, frames[0].shape).astype(np.uint8), None
        else:
            yield frames[i], i


def jump(frames, _focal):
    """Three fifths in, the camera is elsewhere for 60 frames and then back where it was before."""
    count = len(frames)
    away = count * 21 // 25
    for i in [*range(count * 3 // 5), *range(away, min(count, away + 60)), *range(count * 2 // 5, away)]:
        yield frames[i], i


def fast(frames, _focal):
    """A third of the recording at eight times the speed."""
    count = len(frames)
    first, last = count * 2 // 5, count * 18 // 25
    for i in [*range(first), *range(first, last, 8), *range(last, count)]:
        yield frames[i], i


def known_lens(focal):
    return ["--focal", f"{focal:.6g}", "--distortion", ",".join(f"{k:g}" for k in BARREL)]


CONDITIONS = {
    "original": Condition("as it is"),
    "known-focal": Condition("as it is, focal length given", needs_focal=True,
                             given=lambda focal: ["--focal", f"{focal:.6g}"]),
    "half": Condition("half resolution", half, focal=0.5),
    "rate-5": Condition("every fifth frame", every_fifth, every=5),
    "flicker": Condition("gain and gamma flicker 25 %", flicker),
    "blur": Condition("motion blur", blur),
    "jpeg-20": Condition("JPEG quality 20", plain, 20),
    "noise": Condition("noise, sigma 12", noise),
    "barrel": Condition("barrel distortion, k1 -0.3", barrel),
    "barrel-known": Condition("the same with the calibration given", barrel, given=known_lens),
    "crop": Condition("cut to 16:9", crop),
    "occluder": Condition("a person walks through", occluder),
    "rolling": Condition("rolling shutter", rolling),
    "rolling-told": Condition("the same, and the program is told", rolling, given=lambda _: ["--rolling-shutter"]),
    "rotation": Condition("turns 30 degrees on the spot and back", rotation),
    "black": Condition("60 black frames", black),
    "jump": Condition("elsewhere for 60 frames and back", jump),
    "fast": Condition("a third at 8 times the speed", fast),
}
