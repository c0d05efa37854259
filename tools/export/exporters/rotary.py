# SPDX-License-Identifier: MIT
"""Rotary position embedding without tables, in place of those that look up their largest position.

The packages build a table up to `int(positions.max())`, which a graph cannot know."""

from typing import Any, Tuple

import torch


def _rotate(tokens: torch.Tensor, positions: torch.Tensor, base: float) -> torch.Tensor:
    dim = tokens.shape[-1]
    exponents = torch.arange(0, dim, 2, dtype=torch.float32, device=tokens.device) / dim
    angles = positions.to(torch.float32).unsqueeze(-1) * (1.0 / base**exponents)
    angles = torch.cat((angles, angles), dim=-1).unsqueeze(1)
    first, second = tokens.chunk(2, dim=-1)
    turned = torch.cat((-second, first), dim=-1)
    return tokens * angles.cos().to(tokens.dtype) + turned * angles.sin().to(tokens.dtype)


def rotary_2d(tokens: torch.Tensor, positions: torch.Tensor, base: float) -> torch.Tensor:
    """Tokens (B, heads, N, dim), the first half turned by row, the second by column (B, N, 2)."""
    vertical, horizontal = tokens.chunk(2, dim=-1)
    return torch.cat((_rotate(vertical, positions[..., 0], base),
                      _rotate(horizontal, positions[..., 1], base)), dim=-1)


def forward_of(base_attribute: str) -> Any:
    """A forward() for modules that keep the base frequency in `base_attribute`."""

    def forward(self: Any, tokens: torch.Tensor, positions: torch.Tensor) -> torch.Tensor:
        return rotary_2d(tokens, positions, getattr(self, base_attribute))

    return forward


def grid_positions(self: Any, batch_size: int, height: int, width: int,
                   device: torch.device) -> torch.Tensor:
    """(B, height * width, 2) rows and columns: a PositionGetter that keeps no table."""
    del self
    rows = torch.arange(height, device=device).repeat_interleave(width)
    columns = torch.arange(width, device=device).repeat(height)
    return torch.stack((rows, columns), dim=-1).unsqueeze(0).expand(batch_size, -1, -1)


def patches(rope: Any, position_getter: Any, base_attribute: str) -> Tuple[Tuple[Any, str, Any],
                                                                           ...]:
    """Replacements for a package's rotary embedding and its list of positions."""
    return ((rope, "forward", forward_of(base_attribute)),
            (position_getter, "__call__", grid_positions))
