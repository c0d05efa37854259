# SPDX-License-Identifier: MIT
"""A model as two modules: from images to features, and from features to the contract's outputs."""

from typing import Any, Callable, Tuple

import torch

from exporters.options import BuildOptions


class Half(torch.nn.Module):
    """One step of a model: step(model, values, *more)."""

    def __init__(self, model: torch.nn.Module, step: Callable[..., Any], *more: Any):
        super().__init__()
        self.model = model
        self._step = step
        self._more = more

    def forward(self, values: torch.Tensor) -> Any:
        return self._step(self.model, values, *self._more)


def halves(model: torch.nn.Module, options: BuildOptions, encode: Callable[..., torch.Tensor],
           decode: Callable[..., Tuple[torch.Tensor, ...]]) -> Tuple[Half, Half]:
    """Of encode(model, images) and decode(model, features, (height, width))."""
    size = options.height, options.width
    return Half(model, encode).eval(), Half(model, decode, size).eval()
