# SPDX-License-Identifier: MIT
"""Weights of a model: from a file, with its hash, or random ones that are always the same."""

import hashlib
import pickle
from pathlib import Path
from typing import Any, Dict, Optional, Sequence

import torch

from contract.errors import ExportError


def sha256(path: Optional[Path], seed: int = 0) -> str:
    """Hash of the weight file for the metadata; `random:SEED` without one."""
    if path is None:
        return f"random:{seed}"
    digest = hashlib.sha256()
    try:
        with open(path, "rb") as file:
            for block in iter(lambda: file.read(1 << 20), b""):
                digest.update(block)
    except OSError as error:
        raise ExportError(f"{path}: {error.strerror}; give the weight file with --weights")
    return digest.hexdigest()


def _read(path: Path) -> Dict[str, Any]:
    try:
        if path.suffix == ".safetensors":
            from safetensors.torch import load_file
            return load_file(str(path))
        return torch.load(str(path), map_location="cpu", weights_only=True)
    except (OSError, RuntimeError, ValueError, pickle.UnpicklingError) as error:
        reason = str(error).splitlines()[0]
        raise ExportError(f"{path}: not a weight file ({reason}); .safetensors and the tensors of "
                          ".pt, .pth, .ckpt can be read") from error


def load(model: torch.nn.Module, path: Path, ignored: Sequence[str] = ()) -> None:
    """Fills a model. Every parameter must be in the file; of the rest of the file only what is
    `ignored` (prefixes of heads that are not exported)."""
    state = _read(path)
    for outer in ("model", "state_dict"):
        if isinstance(state.get(outer), dict):
            state = state[outer]
    own = model.state_dict()
    names = set(own)
    for prefix in ("module.", "model."):
        stripped = {key[len(prefix):] if key.startswith(prefix) else key: value
                    for key, value in state.items()}
        if len(names & set(stripped)) > len(names & set(state)):
            state = stripped
    held = {own[name].data_ptr() for name in names & set(state)}  # a layer may have two names
    missing = sorted(name for name in names - set(state) if own[name].data_ptr() not in held)
    foreign = sorted(key for key in set(state) - names if not key.startswith(tuple(ignored)))
    if missing or foreign:
        what = f"lacks {missing[0]}" if missing else f"has {foreign[0]}, which the model has not"
        raise ExportError(f"{path}: {what} ({len(missing)} missing, {len(foreign)} foreign); "
                          "give the weights of this model")
    model.load_state_dict({key: state[key] for key in names & set(state)}, strict=False)


def randomise(model: torch.nn.Module, seed: int) -> None:
    """Random weights under which every part of the model changes its outputs.

    The packages' own start values would hide faults: position embeddings and layer scales begin
    at or near zero, so that half of a network has no effect."""
    generator = torch.Generator().manual_seed(seed)
    with torch.no_grad():
        for name, parameter in sorted(model.named_parameters()):
            noise = torch.randn(parameter.shape, generator=generator)
            if parameter.ndim >= 2:
                fan_in = parameter[0].numel() if "embed" not in name else 2500
                parameter.copy_(noise / max(fan_in, 1)**0.5)
            elif name.endswith("gamma") or "ls1" in name or "ls2" in name:
                parameter.copy_(0.2 + 0.05 * noise)
            elif name.endswith("weight"):
                parameter.copy_(1 + 0.1 * noise)
            else:
                parameter.copy_(0.02 * noise)


def fill(model: torch.nn.Module, path: Optional[Path], seed: int,
         ignored: Sequence[str] = ()) -> bool:
    """Weights of the file, or random ones; True when they are random."""
    if path is None:
        randomise(model, seed)
    else:
        load(model, path, ignored)
    model.eval()
    return path is None
