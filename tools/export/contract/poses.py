# SPDX-License-Identifier: MIT
"""What the runtime does to predicted poses, in numpy: nearest rotation, re-anchoring, units.

Poses are world-from-camera, OpenCV axes (x right, y down, z forward), shapes (V, 3, 4)."""

from typing import Sequence

import numpy as np


def nearest_rotation(matrices: np.ndarray) -> np.ndarray:
    """The rotations nearest to (..., 3, 3) matrices in the Frobenius norm."""
    u, _, vt = np.linalg.svd(np.asarray(matrices, dtype=np.float64))
    sign = np.ones(u.shape[:-1])
    sign[..., 2] = np.linalg.det(u @ vt)
    return (u * sign[..., None, :]) @ vt


def inverse(poses: np.ndarray) -> np.ndarray:
    """Inverses of rigid (..., 3, 4) poses."""
    rotation = np.swapaxes(poses[..., :3], -1, -2)
    return np.concatenate([rotation, -rotation @ poses[..., 3:]], axis=-1)


def compose(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """T_a_c of T_a_b and T_b_c, shapes (..., 3, 4)."""
    rotation = a[..., :3] @ b[..., :3]
    return np.concatenate([rotation, a[..., :3] @ b[..., 3:] + a[..., 3:]], axis=-1)


def reanchor(poses: np.ndarray) -> np.ndarray:
    """T_0_i of a model's (V, 3, 4) poses: proper rotations, view 0 exactly the identity."""
    poses = np.asarray(poses, dtype=np.float64)
    rigid = np.concatenate([nearest_rotation(poses[..., :3]), poses[..., 3:]], axis=-1)
    anchored = compose(inverse(rigid[:1]), rigid)
    anchored[0] = np.eye(3, 4)
    return anchored


def unit_spread(ratios: Sequence[float]) -> float:
    """Scatter of depth ratios around their median: median absolute deviation of the logarithm."""
    logs = np.log(np.asarray(ratios, dtype=np.float64))
    return float(np.median(np.abs(logs - np.median(logs))))


def log_median_ratio(depth_a: np.ndarray, depth_b: np.ndarray) -> float:
    """log median(depth_a / depth_b) over pixels with depth in both; nan without any."""
    both = (depth_a > 0) & (depth_b > 0)
    if not both.any():
        return float("nan")
    return float(np.log(np.median(depth_a[both] / depth_b[both])))
