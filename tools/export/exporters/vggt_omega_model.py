# SPDX-License-Identifier: MIT
"""VGGT-Omega: dense head and camera head; its cameras are camera-from-world, as VGGT's."""

from functools import partial
from typing import List, Tuple

import torch
from vggt_omega.models import vggt_omega

from exporters import weights
from exporters.geometry import decode_pose_encoding, invert_rigid
from exporters.options import BuildOptions
from exporters.patching import Patch, patched

_REDUCED_DEPTH = 4
_REDUCED_ENCODER = 2
_HEADS_NOT_EXPORTED = ("text_alignment_head.",)


class Wrapper(torch.nn.Module):
    """Images in [0, 1]. Calls the parts one by one: the model's forward() turns CUDA's automatic
    precision on."""

    def __init__(self, model: torch.nn.Module):
        super().__init__()
        self.model = model

    def forward(self, images: torch.Tensor) -> Tuple[torch.Tensor, ...]:
        tokens, first_patch = self.model.aggregator(images)
        encoding = self.model.camera_head(tokens, patch_token_start=first_patch)
        depth, confidence = self.model.dense_head(tokens, images=images,
                                                  patch_token_start=first_patch)
        camera_from_world, intrinsics = decode_pose_encoding(encoding, *images.shape[-2:])
        return depth.squeeze(-1), confidence, invert_rigid(camera_from_world), intrinsics


def _unmask_biases(model: torch.nn.Module) -> None:
    """The mask of the key biases, which comes with the weights and is NaN without them."""
    for module in model.modules():
        mask = getattr(module, "bias_mask", None)
        if mask is not None:
            third = mask.numel() // 3
            mask.fill_(1.0)
            mask[third:2 * third].fill_(0.0)


def build(options: BuildOptions) -> torch.nn.Module:
    smaller = partial(vggt_omega.Aggregator, depth=_REDUCED_DEPTH,
                      register_attention_block_indices=[2],
                      cached_layer_indices=tuple(range(_REDUCED_DEPTH)))
    with patched([(vggt_omega, "Aggregator", smaller)] if options.reduced else []):
        model = vggt_omega.VGGTOmega()
    if options.reduced:
        encoder = model.aggregator.patch_embed
        encoder.blocks = encoder.blocks[:_REDUCED_ENCODER]
        model.dense_head.intermediate_layer_idx = list(range(_REDUCED_DEPTH))
    if weights.fill(model, options.weights, options.seed, ignored=_HEADS_NOT_EXPORTED):
        _unmask_biases(model)
        with torch.no_grad():  # a small turn, a field of view of 1 rad
            last = model.camera_head.camera_branch[2]
            last.weight.mul_(0.2)
            last.bias.copy_(torch.tensor([0.0, 0, 0, 0, 0, 0, 1, 1, 1]))
    return Wrapper(model)


def patches() -> List[Patch]:
    return []
