# SPDX-License-Identifier: MIT
"""What becomes one ONNX file: a whole model, or its encoder and the rest apart.

An encoder sees one view, so that a runtime keeps what it gives for every pair and window that the
view takes part in."""

import hashlib
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Dict, List, Tuple

import torch

from contract.card import MAX_VIEWS, encoder_path, split_metadata
from exporters.options import BuildOptions

_EXAMPLE_VIEWS = 3  # neither 1 nor 2, which tracing would take for constants


@dataclass(frozen=True)
class Part:
    """A module with one input, and what its file is called and says."""

    module: torch.nn.Module
    path: Path
    metadata: Dict[str, str]
    input: str
    outputs: Tuple[str, ...]
    example: torch.Tensor
    free_views: bool


def example_input(options: BuildOptions, views: int, seed: int = 0) -> torch.Tensor:
    """Smooth random images as the model wants them: (1, V, 3, H, W), or (1, 3, H, W)."""
    generator = torch.Generator().manual_seed(seed)
    coarse = torch.rand((views, 3, 7, 9), generator=generator)
    images = torch.nn.functional.interpolate(coarse, size=(options.height, options.width),
                                             mode="bilinear", align_corners=False)
    card = options.card
    mean = torch.tensor(card.mean).reshape(1, 3, 1, 1)
    std = torch.tensor(card.std).reshape(1, 3, 1, 1)
    images = (images - mean) / std
    return images[:1] if card.kind == "descriptor" else images.unsqueeze(0)


def _views(options: BuildOptions) -> int:
    return 2 if options.card.kind == "pair" else _EXAMPLE_VIEWS


def whole(model: torch.nn.Module, options: BuildOptions, path: Path,
          metadata: Dict[str, str]) -> List[Part]:
    card = options.card
    return [Part(model, path, metadata, card.input, card.outputs,
                 example_input(options, _views(options)), card.kind == "multiview")]


def split(model: torch.nn.Module, module: ModuleType, options: BuildOptions, path: Path,
          metadata: Dict[str, str]) -> List[Part]:
    """The encoder, then the rest, which takes its features."""
    card = options.card
    encoder, rest = module.split(model, options)
    images = example_input(options, _views(options))
    with torch.no_grad():
        features = torch.cat([encoder(images[:, k:k + 1]) for k in range(images.shape[1])], dim=1)
    said = " ".join(metadata[f"unisim.{key}"] for key in ("model", "height", "width",
                                                          "weights_sha256"))
    identity = hashlib.sha256(f"{said} reduced {options.reduced}".encode()).hexdigest()
    of_encoder, of_rest = split_metadata(metadata, identity)
    return [Part(encoder, encoder_path(path), of_encoder, "images", ("features",), images[:, :1],
                 False),
            Part(rest, path, of_rest, "features", card.outputs, features,
                 card.kind == "multiview")]


def dynamic_shapes(part: Part) -> object:
    if not part.free_views:
        return None
    return ({1: torch.export.Dim("views", min=2, max=MAX_VIEWS)},)
