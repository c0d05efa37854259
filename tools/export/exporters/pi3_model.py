# SPDX-License-Identifier: MIT
"""pi3: points of each camera and world-from-camera poses; focal lengths come from the points."""

from typing import Any, List, Tuple

import torch
from pi3.models import pi3
from pi3.models.layers import camera_head, pos_embed

from exporters import rotary, weights
from exporters.geometry import normalised_rows, pinhole_of_points
from exporters.options import BuildOptions
from exporters.patching import Patch

_REDUCED_DECODER = 4
_REDUCED_ENCODER = 2


class Wrapper(torch.nn.Module):
    """Images in [0, 1]. No view is the reference; the runtime anchors to the first."""

    def __init__(self, model: torch.nn.Module):
        super().__init__()
        self.model = model

    def forward(self, images: torch.Tensor) -> Tuple[torch.Tensor, ...]:
        found = self.model(images)
        points = found["local_points"]
        confidence = torch.sigmoid(found["conf"].squeeze(-1))
        return (points[..., 2], confidence, found["camera_poses"][..., :3, :],
                pinhole_of_points(points, confidence))


def _start_open(model: torch.nn.Module) -> None:
    """Random weights whose points lie on rays that diverge: a focal length that is positive."""
    size = model.patch_size
    with torch.no_grad():
        head = model.point_head.proj
        head.weight.mul_(0.1)
        rays = (torch.arange(size) + 0.5) / size - 0.5
        bias = head.bias.reshape(3, size, size)
        bias.copy_(torch.stack((rays.repeat(size, 1), rays.repeat(size, 1).T,
                                torch.zeros(size, size))))
        model.camera_head.fc_rot.weight.mul_(0.2)
        model.camera_head.fc_rot.bias.copy_(torch.eye(3).flatten())


def build(options: BuildOptions) -> torch.nn.Module:
    model = pi3.Pi3()
    if options.reduced:
        model.decoder = model.decoder[:_REDUCED_DECODER]
        model.encoder.blocks = model.encoder.blocks[:_REDUCED_ENCODER]
    if weights.fill(model, options.weights, options.seed):
        _start_open(model)
    return Wrapper(model)


def _mean(self: Any, features: torch.Tensor) -> torch.Tensor:
    del self
    return features.mean(dim=(-2, -1), keepdim=True)


def _rows(self: Any, matrices: torch.Tensor) -> torch.Tensor:
    del self
    return normalised_rows(matrices)


def patches() -> List[Patch]:
    return [
        *rotary.patches(pos_embed.RoPE2D, pos_embed.PositionGetter, "base"),
        (camera_head.CameraHead, "svd_orthogonalize", _rows),
        (torch.nn.AdaptiveAvgPool2d, "forward", _mean),
    ]
