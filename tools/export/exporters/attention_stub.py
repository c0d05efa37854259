# SPDX-License-Identifier: MIT
"""A stand-in for xformers where it is not installed: the same attention by torch's own function."""

import importlib.util
import sys
from types import ModuleType

import torch


def memory_efficient_attention(query: torch.Tensor, key: torch.Tensor, value: torch.Tensor,
                               scale: float = None, p: float = 0.0) -> torch.Tensor:
    """Of (B, N, heads, dim), as xformers lays them out."""
    q, k, v = (tensor.transpose(1, 2) for tensor in (query, key, value))
    found = torch.nn.functional.scaled_dot_product_attention(q, k, v, dropout_p=p, scale=scale)
    return found.transpose(1, 2)


def install() -> None:
    """Lets `import xformers.ops` succeed. An installed xformers is left alone."""
    if "xformers" in sys.modules or importlib.util.find_spec("xformers") is not None:
        return
    package, ops = ModuleType("xformers"), ModuleType("xformers.ops")
    ops.memory_efficient_attention = memory_efficient_attention
    package.ops = ops
    sys.modules.update({"xformers": package, "xformers.ops": ops})
