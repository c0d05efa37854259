# SPDX-License-Identifier: MIT
"""VGGT: depth head and camera head; its cameras are camera-from-world and have to be inverted."""

from functools import partial
from typing import Any, List, Tuple

import torch
from vggt.heads import dpt_head, utils
from vggt.layers import rope
from vggt.models import vggt

from exporters import rotary, weights
from exporters.geometry import decode_pose_encoding, invert_rigid
from exporters.options import BuildOptions
from exporters.patching import Patch, patched

_REDUCED_DEPTH = 3
_REDUCED_ENCODER = 2
_HEADS_NOT_EXPORTED = ("point_head.", "track_head.")


class Wrapper(torch.nn.Module):
    """Images in [0, 1]; the graph normalises them."""

    def __init__(self, model: torch.nn.Module):
        super().__init__()
        self.model = model

    def forward(self, images: torch.Tensor) -> Tuple[torch.Tensor, ...]:
        tokens, first_patch = self.model.aggregator(images)
        encoding = self.model.camera_head(tokens)[-1]
        depth, confidence = self.model.depth_head(tokens, images=images,
                                                  patch_start_idx=first_patch)
        camera_from_world, intrinsics = decode_pose_encoding(encoding, *images.shape[-2:])
        return depth.squeeze(-1), confidence, invert_rigid(camera_from_world), intrinsics


def build(options: BuildOptions) -> torch.nn.Module:
    smaller = partial(vggt.Aggregator, depth=_REDUCED_DEPTH)
    with patched([(vggt, "Aggregator", smaller)] if options.reduced else []):
        model = vggt.VGGT(enable_point=False, enable_track=False)
    if options.reduced:
        encoder = model.aggregator.patch_embed
        encoder.blocks = encoder.blocks[:_REDUCED_ENCODER]
        model.depth_head.intermediate_layer_idx = [_REDUCED_DEPTH - 1] * 4
    if weights.fill(model, options.weights, options.seed, ignored=_HEADS_NOT_EXPORTED):
        with torch.no_grad():  # summed over four rounds: a small turn, a field of view of 1 rad
            branch = model.camera_head.pose_branch.fc2
            branch.weight.mul_(0.05)
            branch.bias.copy_(torch.tensor([0.0, 0, 0, 0, 0, 0, 0.25, 0.25, 0.25]))
    return Wrapper(model)


def _all_frames_at_once(original: Any) -> Any:
    def forward(self: Any, *inputs: Any, **named: Any) -> Any:
        return original(self, *inputs, **{**named, "frames_chunk_size": None})

    return forward


def _sine_cosine(embed_dim: int, pos: torch.Tensor, omega_0: float = 100.0) -> torch.Tensor:
    """(M, embed_dim) of M positions, in float: TensorRT has no double."""
    steps = torch.arange(embed_dim // 2, dtype=torch.float32, device=pos.device)
    angles = pos.reshape(-1, 1) * omega_0**(-2.0 * steps / embed_dim)
    return torch.cat((angles.sin(), angles.cos()), dim=1)


def patches() -> List[Patch]:
    return [
        *rotary.patches(rope.RotaryPositionEmbedding2D, rope.PositionGetter, "base_frequency"),
        (dpt_head.DPTHead, "forward", _all_frames_at_once(dpt_head.DPTHead.forward)),
        (utils, "make_sincos_pos_embed", _sine_cosine),
    ]
