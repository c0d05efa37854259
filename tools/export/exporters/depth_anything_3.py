# SPDX-License-Identifier: MIT
"""Depth Anything 3, small and base: depth and confidence from its dual head, pose from tokens."""

import os
from typing import List, Tuple

import torch

os.environ.setdefault("DA3_LOG_LEVEL", "WARN")  # else the package prints between the results
from depth_anything_3.cfg import create_object, load_config  # noqa: E402
from depth_anything_3.model.dinov2 import vision_transformer  # noqa: E402
from depth_anything_3.model.dinov2.layers import rope  # noqa: E402
from depth_anything_3.registry import MODEL_REGISTRY  # noqa: E402

from exporters import rotary, weights  # noqa: E402
from exporters.geometry import invert_rigid  # noqa: E402
from exporters.options import BuildOptions  # noqa: E402
from exporters.patching import Patch  # noqa: E402

_KEPT_BLOCKS = 6  # alternating attention starts at block 4


class Wrapper(torch.nn.Module):
    """Images normalised by the caller. The first view is the reference, never one chosen by
    content, so that views keep their order and the graph has no branch."""

    def __init__(self, net: torch.nn.Module):
        super().__init__()
        self.net = net

    def forward(self, images: torch.Tensor) -> Tuple[torch.Tensor, ...]:
        found = self.net(images, ref_view_strategy="first")
        return (found["depth"], found["depth_conf"], invert_rigid(found["extrinsics"]),
                found["intrinsics"])


def build(options: BuildOptions) -> torch.nn.Module:
    config = load_config(str(MODEL_REGISTRY[options.card.name]))
    net = create_object(config)
    net.cam_enc = None  # takes known poses in; none are known here
    if options.reduced:
        encoder = net.backbone.pretrained
        encoder.blocks = encoder.blocks[:_KEPT_BLOCKS]
        net.backbone.out_layers = list(range(_KEPT_BLOCKS - 4, _KEPT_BLOCKS))
    if weights.fill(net, options.weights, options.seed, ignored=("cam_enc.",)):
        with torch.no_grad():
            net.cam_dec.fc_fov[0].bias.fill_(1.0)
            net.cam_dec.fc_qvec.bias.copy_(torch.tensor([0.0, 0.0, 0.0, 1.0]))
    return Wrapper(net)


def patches() -> List[Patch]:
    return [
        *rotary.patches(rope.RotaryPositionEmbedding2D, rope.PositionGetter, "base_frequency"),
        (vision_transformer, "THRESH_FOR_REF_SELECTION", 1 << 30),
    ]
