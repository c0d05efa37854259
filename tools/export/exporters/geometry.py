# SPDX-License-Identifier: MIT
"""From what models predict to the contract, in torch: poses, focal lengths. All exportable."""

from typing import Tuple

import torch

SMALLEST_TANGENT = 1e-6  # a field of view of 0 would be an infinite focal length


def invert_rigid(poses: torch.Tensor) -> torch.Tensor:
    """(..., 3, 4) inverses of rigid (..., 3 or 4, 4) poses."""
    rotation = poses[..., :3, :3].transpose(-1, -2)
    return torch.cat([rotation, -rotation @ poses[..., :3, 3:]], dim=-1)


def quaternion_matrix(xyzw: torch.Tensor) -> torch.Tensor:
    """(..., 3, 3) rotations of (..., 4) quaternions x y z w of any length."""
    x, y, z, w = torch.unbind(xyzw, dim=-1)
    s = 2.0 / (xyzw * xyzw).sum(dim=-1)
    rows = (1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w),
            s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w),
            s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y))
    return torch.stack(rows, dim=-1).unflatten(-1, (3, 3))


def pinhole(fx: torch.Tensor, fy: torch.Tensor, height: int, width: int) -> torch.Tensor:
    """(..., 3, 3) intrinsics with the principal point in the middle of the image."""
    zero, one = torch.zeros_like(fx), torch.ones_like(fx)
    rows = (fx, zero, one * (width / 2), zero, fy, one * (height / 2), zero, zero, one)
    return torch.stack(rows, dim=-1).unflatten(-1, (3, 3))


def decode_pose_encoding(encoding: torch.Tensor, height: int,
                         width: int) -> Tuple[torch.Tensor, torch.Tensor]:
    """Pose (..., 3, 4), as encoded, and intrinsics of translation, quaternion, two fields of view.

    The encoding (..., 9) is that of VGGT: t, x y z w, vertical and horizontal angle in rad."""
    pose = torch.cat([quaternion_matrix(encoding[..., 3:7]), encoding[..., :3, None]], dim=-1)
    tangent = torch.tan(encoding[..., 7:9] / 2).clamp(min=SMALLEST_TANGENT)
    return pose, pinhole(width / 2 / tangent[..., 1], height / 2 / tangent[..., 0], height, width)


def pinhole_of_points(points: torch.Tensor, weights: torch.Tensor) -> torch.Tensor:
    """Intrinsics (..., 3, 3) that explain (..., H, W, 3) points of the camera frame best.

    Weighted least squares of u = f x/z, closed form; pixel centres lie at halves."""
    height, width = points.shape[-3], points.shape[-2]
    v = torch.arange(height, dtype=points.dtype, device=points.device) + 0.5 - height / 2
    u = torch.arange(width, dtype=points.dtype, device=points.device) + 0.5 - width / 2
    x, y = points[..., 0] / points[..., 2], points[..., 1] / points[..., 2]
    fx = (weights * x * u).sum((-1, -2)) / (weights * x * x).sum((-1, -2))
    fy = (weights * y * v[:, None]).sum((-1, -2)) / (weights * y * y).sum((-1, -2))
    return pinhole(fx, fy, height, width)


def normalised_rows(matrices: torch.Tensor) -> torch.Tensor:
    """(N, 3, 3) of 9 numbers each, rows of length 1: the runtime takes the nearest rotation.

    Stands in for projections by singular values, which ONNX has no operator for; they start from
    the same matrix."""
    return torch.nn.functional.normalize(matrices.reshape(-1, 3, 3), p=2.0, dim=-1)
