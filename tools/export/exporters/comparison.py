# SPDX-License-Identifier: MIT
"""How far an ONNX file is from the torch model, output by output, and golden outputs of it."""

from pathlib import Path
from typing import Dict, List

import numpy as np

from contract.poses import reanchor
from exporters.runner import Outputs


def as_used(outputs: Outputs) -> Outputs:
    """Poses as the runtime sees them: proper rotations, first view the identity."""
    used = dict(outputs)
    if "pose" in used:
        used["pose"] = reanchor(used["pose"][0])[None]
    return used


def relative_differences(found: Outputs, expected: Outputs) -> Dict[str, float]:
    """Largest difference of each output over the largest magnitude of what is expected.

    Depth and intrinsics are compared entry by entry, so that a short focal length is not hidden
    behind a large principal point; of confidence only the order counts."""
    differences = {}
    found = as_used(found)
    for name, reference in as_used(expected).items():
        value = found[name]
        if value.shape != reference.shape or not np.isfinite(value).all():
            differences[name] = float("inf")
            continue
        scale = np.abs(reference)
        if name not in ("depth", "intrinsics"):
            scale = scale.max()
        differences[name] = float((np.abs(value - reference) / np.maximum(scale, 1e-12)).max())
    return differences


def write_golden(folder: Path, name: str, values: np.ndarray, outputs: Outputs) -> Path:
    """Input and torch outputs of one call, compressed, for tests of any runtime."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}.npz"
    np.savez_compressed(path, input=values, **outputs)
    return path


def table(views: int, differences: Dict[str, float]) -> List[str]:
    return [f"views {views:2d}  {name:16s} max rel difference {value:.2e}"
            for name, value in differences.items()]
