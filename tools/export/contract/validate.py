# SPDX-License-Identifier: MIT
"""The rejections of the runtime: what a prediction may not contain."""

from typing import Dict, Optional

import numpy as np


MIN_POSE_CONFIDENCE = 0.75


def fault(outputs: Dict[str, np.ndarray],
          min_pose_confidence: float = MIN_POSE_CONFIDENCE) -> Optional[str]:
    """None for a usable prediction, else one line naming the output and what is wrong with it."""
    for name, values in outputs.items():
        if not np.isfinite(values).all():
            return f"{name} has values that are not finite"
    if (outputs["depth"] <= 0).any():
        return f"depth {outputs['depth'].min():.3g} is not above 0"
    focals = outputs["intrinsics"][..., (0, 1), (0, 1)]
    if (focals <= 0).any():
        return f"focal length {focals.min():.3g} px is not above 0"
    sure = outputs.get("pose_confidence")
    if sure is not None and sure.min() < min_pose_confidence:
        return f"pose confidence {sure.min():.3g} is below {min_pose_confidence:g}"
    return None
