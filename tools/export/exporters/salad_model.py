# SPDX-License-Identifier: MIT
"""SALAD: place descriptor of one image; DINOv2 by timm, whose parameters have the same names."""

from typing import List

import timm
import torch
from models.aggregators.salad import SALAD

from exporters import weights
from exporters.options import BuildOptions
from exporters.patching import Patch

_ENCODER = "vit_base_patch14_dinov2.lvd142m"
_PATCH = 14
_REDUCED_ENCODER = 3
_OFFSET = 0.1  # DINOv2 enlarges its grid by a tenth of a patch when it resizes position embeddings


class Backbone(torch.nn.Module):
    """The encoder; `model` is its name in the weight file."""

    def __init__(self) -> None:
        super().__init__()
        self.model = timm.create_model(_ENCODER, pretrained=False)


class Descriptor(torch.nn.Module):
    """Image (1, 3, H, W), normalised by the caller, to (1, 8448) of length 1."""

    def __init__(self) -> None:
        super().__init__()
        self.backbone = Backbone()
        self.aggregator = SALAD(num_channels=768, num_clusters=64, cluster_dim=128, token_dim=256)

    def _positions(self, rows: int, columns: int) -> torch.Tensor:
        table = self.backbone.model.pos_embed
        side = int((table.shape[1] - 1)**0.5)
        grid = table[:, 1:].reshape(1, side, side, -1).permute(0, 3, 1, 2)
        scale = ((rows + _OFFSET) / side, (columns + _OFFSET) / side)
        grid = torch.nn.functional.interpolate(grid, scale_factor=scale, mode="bicubic")
        return torch.cat((table[:, :1], grid.flatten(2).transpose(1, 2)), dim=1)

    def forward(self, image: torch.Tensor) -> torch.Tensor:
        rows, columns = image.shape[-2] // _PATCH, image.shape[-1] // _PATCH
        encoder = self.backbone.model
        tokens = encoder.patch_embed.proj(image).flatten(2).transpose(1, 2)
        tokens = torch.cat((encoder.cls_token, tokens), dim=1) + self._positions(rows, columns)
        for block in encoder.blocks:
            tokens = block(tokens)
        tokens = encoder.norm(tokens)
        features = tokens[:, 1:].transpose(1, 2).unflatten(-1, (rows, columns))
        return self.aggregator((features, tokens[:, 0]))


def build(options: BuildOptions) -> torch.nn.Module:
    model = Descriptor()
    model.backbone.model.head = torch.nn.Identity()
    if options.reduced:
        encoder = model.backbone.model
        encoder.blocks = encoder.blocks[:_REDUCED_ENCODER]
    weights.fill(model, options.weights, options.seed, ignored=("backbone.model.mask_token",))
    return model


def patches() -> List[Patch]:
    return []
