# SPDX-License-Identifier: MIT
"""STA, the two-view model of ViSTA-SLAM: points of each view in its own camera, relative pose."""

from typing import Any, List, Sequence, Tuple

import torch

from contract.errors import BAD_USAGE, ExportError
from exporters import attention_stub, rotary, weights
from exporters.geometry import normalised_rows, pinhole_of_points
from exporters.halves import halves
from exporters.options import BuildOptions
from exporters.patching import Patch

attention_stub.install()
from vista_slam.sta_model import pos_embed  # noqa: E402
from vista_slam.sta_model.blocks import sta_blocks  # noqa: E402
from vista_slam.sta_model.heads import pose_head  # noqa: E402
from vista_slam.sta_model.sta_model import SymmetricTwoViewAssociation  # noqa: E402

_PATCH = 16
_REDUCED_ENCODER = 3


class Wrapper(torch.nn.Module):
    """Images in [-1, 1], exactly two. The pose token of a view gives its camera in the other's."""

    def __init__(self, model: torch.nn.Module):
        super().__init__()
        self.model = model

    def forward(self, images: torch.Tensor) -> Tuple[torch.Tensor, ...]:
        features, positions = zip(*(self.model._encode_image(images[:, k], None, normalize=False)
                                    for k in range(2)))
        return _decode(self.model, features, positions, images.shape[-2:])


def _encode(model: torch.nn.Module, images: torch.Tensor) -> torch.Tensor:
    """One image (1, 1, 3, H, W) to features (1, 1, N, C)."""
    return model._encode_image(images[:, 0], None, normalize=False)[0].unsqueeze(1)


def _decode_features(model: torch.nn.Module, features: torch.Tensor,
                     size: Tuple[int, int]) -> Tuple[torch.Tensor, ...]:
    """Features (1, 2, N, C) of two images to the outputs of the contract."""
    rows, columns = (side // _PATCH for side in size)
    positions = rotary.grid_positions(model, 1, rows, columns, features.device)
    return _decode(model, features.unbind(dim=1), (positions, positions), size)


def _decode(model: torch.nn.Module, features: Sequence[torch.Tensor],
            positions: Sequence[torch.Tensor], size: Tuple[int, int]) -> Tuple[torch.Tensor, ...]:
    decoded = model._decode_stereo(*features, *positions)
    heads = [model.downstream_head_pts([feature] + [tokens[:, 1:] for tokens in layers], size)
             for feature, layers in zip(features, decoded)]
    turned = [model.head_pose_s(layers[-1][:, 0]) for layers in decoded]
    points = torch.stack([head["pts3d"] for head in heads], dim=1)
    confidence = torch.stack([head["conf"] for head in heads], dim=1)
    T_0_1 = turned[1]["pose"][:, :3]
    T_0_0 = torch.eye(4, dtype=T_0_1.dtype, device=T_0_1.device)[:3].expand_as(T_0_1)
    pose = torch.stack((T_0_0, T_0_1), dim=1)
    sure = torch.stack([found["conf"] for found in turned], dim=1)
    return (points[..., 2], confidence, pose, pinhole_of_points(points, confidence), sure)


def split(whole: Wrapper, options: BuildOptions) -> Tuple[torch.nn.Module, torch.nn.Module]:
    return halves(whole.model, options, _encode, _decode_features)


def build(options: BuildOptions) -> torch.nn.Module:
    if options.width < options.height:
        raise ExportError(f"--size {options.height}x{options.width}: sta takes landscape or "
                          "square images", BAD_USAGE)
    model = SymmetricTwoViewAssociation(img_size=(options.height, options.width))
    if options.reduced:
        model.enc_blocks = model.enc_blocks[:_REDUCED_ENCODER]
    if weights.fill(model, options.weights, options.seed):
        with torch.no_grad():  # small turns, points in a narrow cone that is well in front
            head = model.head_pose_s
            head.fc_rot.weight.mul_(0.2)
            head.fc_rot.bias.copy_(torch.eye(3).flatten())
            points = model.downstream_head_pts.dpt.head[-1]  # x, y, z, confidence
            points.weight.mul_(0.02)
            points.bias.copy_(torch.tensor([0.0, 0.0, 1.0, 0.0]))
    return Wrapper(model)


def _rows(self: Any, matrices: torch.Tensor) -> torch.Tensor:
    del self
    return normalised_rows(matrices)


def patches() -> List[Patch]:
    return [
        *rotary.patches(pos_embed.RoPE2D, sta_blocks.PositionGetter, "base"),
        (pose_head.PoseHead_small, "svd_orthogonalize", _rows),
    ]
