# SPDX-License-Identifier: MIT
"""MapAnything from images alone: rays, depth along them, pose; metric by one factor per call."""

import io
import math
from contextlib import redirect_stdout
from typing import Any, List, Optional, Tuple

import torch
from mapanything import models
from mapanything.models.external.dinov2.hub import backbones
from uniception.models.encoders import ViTEncoderInput

from exporters import weights
from exporters.geometry import pinhole_of_points, quaternion_matrix
from exporters.halves import halves
from exporters.options import BuildOptions
from exporters.patching import Patch, patched

_REDUCED = ("model.encoder.keep_first_n_layers=2", "model.info_sharing.module_args.depth=4",
            "model.info_sharing.module_args.indices=[1,2]")


class Wrapper(torch.nn.Module):
    """Images normalised by the caller, no other input. The first view is the reference."""

    def __init__(self, model: torch.nn.Module):
        super().__init__()
        self.model = model

    def forward(self, images: torch.Tensor) -> Tuple[torch.Tensor, ...]:
        norm = [self.model.encoder.data_norm_type]
        views = self.model([{"img": images[:, k], "data_norm_type": norm}
                            for k in range(images.shape[1])])
        return _contract(*(torch.stack([view[key] for view in views], dim=1)
                           for key in ("pts3d_cam", "conf", "cam_trans", "cam_quats")))


def _contract(points: torch.Tensor, confidence: torch.Tensor, translation: torch.Tensor,
              quaternion: torch.Tensor) -> Tuple[torch.Tensor, ...]:
    pose = torch.cat([quaternion_matrix(quaternion), translation.unsqueeze(-1)], dim=-1)
    return points[..., 2], confidence, pose, pinhole_of_points(points, confidence)


def _encode(model: torch.nn.Module, images: torch.Tensor) -> torch.Tensor:
    """Images (1, V, 3, H, W) to features (1, V, N + 1, C): tokens of the patches of each view, then
    its class token."""
    norm = model.encoder.data_norm_type
    found = model.encoder(ViTEncoderInput(image=images[0], data_norm_type=norm))
    tokens = torch.cat([found.features.flatten(2), found.registers], dim=2)
    return tokens.transpose(1, 2).unsqueeze(0)


def _decode(model: torch.nn.Module, features: torch.Tensor,
            size: Tuple[int, int]) -> Tuple[torch.Tensor, ...]:
    """All views on one tensor: the authors' code takes a list of views, whose length a graph cannot
    leave open, and adds zeros for the inputs that are not there."""
    rows, columns = (side // model.encoder.patch_size for side in size)
    patches = model.fusion_norm_layer(features[0, :, :-1])
    kept, scale = _share(model.info_sharing, torch.cat([patches, features[0, :, -1:]], dim=1),
                         model.scale_token.reshape(1, 1, -1))
    maps = [tokens[:, :rows * columns].transpose(1, 2).unflatten(2, (rows, columns))
            for tokens in (patches, *kept)]
    dense, pose, metric = model.downstream_head(maps, scale.transpose(1, 2), tuple(size))
    rays, depth = dense.value.permute(0, 2, 3, 1).split([3, 1], dim=-1)
    translation, quaternion = pose.value.split([3, 4], dim=-1)
    return _contract(*(found.unsqueeze(0) for found in (
        rays * depth * metric.reshape(1, 1, 1, 1), dense.confidence.squeeze(1),
        translation * metric, quaternion)))


def _share(blocks: torch.nn.Module, tokens: torch.Tensor,
           scale: torch.Tensor) -> Tuple[List[torch.Tensor], torch.Tensor]:
    """Attention over all views and within each, in turns, with one more token for the scale.

    Tokens (V, N, C) and scale (1, 1, C) to tokens of three depths and the scale."""
    views = tokens.shape[0]
    tokens, scale = blocks.proj_embed(tokens), blocks.proj_embed(scale)
    if blocks.distinguish_ref_and_non_ref_views:
        tokens = torch.cat([tokens[:1] + blocks.view_pos_table[0], tokens[1:]], dim=0)
    kept = []
    for k, block in enumerate(blocks.self_attention_blocks):
        if k % 2 == 0:
            all_views = block(torch.cat([tokens.flatten(0, 1).unsqueeze(0), scale], dim=1))
            tokens, scale = all_views[0, :-1].unflatten(0, (views, -1)), all_views[:, -1:]
        else:
            tokens = block(tokens)
        if k in blocks.indices:
            kept.append(tokens)
    return [blocks.norm(found) for found in (*kept, tokens)], blocks.norm(scale)


def _all_views_at_once(self: Wrapper, images: torch.Tensor) -> Tuple[torch.Tensor, ...]:
    return _decode(self.model, _encode(self.model, images), images.shape[-2:])


def split(whole: Wrapper, options: BuildOptions) -> Tuple[torch.nn.Module, torch.nn.Module]:
    return halves(whole.model, options, _encode, _decode)


def _local_encoder(repository: str, name: str, **unused: Any) -> torch.nn.Module:
    """In place of torch.hub, which would load code and weights from the network: the package has a
    copy of the code, and the weights come with those of the whole model. Takes no memory yet."""
    del repository, unused
    with torch.device("meta"):
        return getattr(backbones, name)(pretrained=False, drop_path_uniform=True)


def _blank(reduced: bool) -> torch.nn.Module:
    overrides = ["model=mapanything", "machine=default", *(_REDUCED if reduced else [])]
    config = models._init_hydra_config("configs/train.yaml", overrides).model
    with patched([(torch.hub, "load", _local_encoder)]), redirect_stdout(io.StringIO()):
        model = models.init_model(config.model_str, config.model_config)
    model.encoder.to_empty(device="cpu")
    return model


def _start_open(model: torch.nn.Module) -> None:
    """Random weights whose rays look ahead in a narrow cone, and small turns."""
    with torch.no_grad():
        rays = model.dpt_regressor_head.conv2[-1]  # x, y, z, depth, confidence, mask
        rays.weight[:3].mul_(0.1)
        rays.bias[:3].copy_(torch.tensor([0.0, 0.0, 1.0]))
        model.pose_head.fc_rot.weight.mul_(0.2)
        model.pose_head.fc_rot.bias.copy_(torch.tensor([0.0, 0.0, 0.0, 1.0]))


def build(options: BuildOptions) -> torch.nn.Module:
    model = _blank(options.reduced)
    if weights.fill(model, options.weights, options.seed):
        _start_open(model)
    return Wrapper(model)


def _clip(self: torch.Tensor, min: Optional[float] = None,
          max: Optional[float] = None) -> torch.Tensor:
    """Without bounds at infinity, which the exporter makes tensors of and fails on."""
    bounds = {name: value for name, value in (("min", min), ("max", max))
              if value is not None and math.isfinite(value)}
    return self.clamp(**bounds) if bounds else self


def patches() -> List[Patch]:
    return [(Wrapper, "forward", _all_views_at_once), (torch.Tensor, "clip", _clip)]
