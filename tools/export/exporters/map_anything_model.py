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


def _share(blocks: torch.nn.Module, patches: torch.Tensor, classes: torch.Tensor,
           scale: torch.Tensor) -> Tuple[List[torch.Tensor], torch.Tensor]:
    """Attention over all views and within each, in turns, with one more token for the scale.

    Patches (V, C, h, w), class tokens (V, C, 1) and scale (1, 1, C) to the maps of three depths
    and the scale token (1, C, 1)."""
    views, _, height, width = patches.shape
    tokens = torch.cat([patches.flatten(2), classes], dim=2).transpose(1, 2)
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
    maps = [blocks.norm(found)[:, :height * width].transpose(1, 2).unflatten(2, (height, width))
            for found in (*kept, tokens)]
    return maps, blocks.norm(scale).transpose(1, 2)


def _all_views_at_once(self: Wrapper, images: torch.Tensor) -> Tuple[torch.Tensor, ...]:
    """The same on one tensor: the authors' code takes a list of views, whose length a graph cannot
    leave open, and zeros in place of the inputs that are not there."""
    model = self.model
    encoded = model.encoder(ViTEncoderInput(image=images[0],
                                            data_norm_type=model.encoder.data_norm_type))
    patches = model.fusion_norm_layer(encoded.features.permute(0, 2, 3, 1)).permute(0, 3, 1, 2)
    maps, scale = _share(model.info_sharing, patches, encoded.registers,
                         model.scale_token.reshape(1, 1, -1))
    dense, pose, metric = model.downstream_head([patches, *maps], scale, tuple(images.shape[-2:]))
    rays, depth = dense.value.permute(0, 2, 3, 1).split([3, 1], dim=-1)
    translation, quaternion = pose.value.split([3, 4], dim=-1)
    confidence = dense.confidence.squeeze(1)
    return _contract(*(found.unsqueeze(0) for found in (
        rays * depth * metric.reshape(1, 1, 1, 1), confidence, translation * metric, quaternion)))


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
