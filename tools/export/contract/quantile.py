# SPDX-License-Identifier: MIT
"""Confidence by quantile: of what a model calls confidence only the order counts."""

import numpy as np


def quantiles(values: np.ndarray) -> np.ndarray:
    """Rank of each value among all of them, 0 to 1; equal values share the mean of theirs."""
    if values.size < 2:
        return values.astype(np.float32)
    _, group, counts = np.unique(values, return_inverse=True, return_counts=True)
    mean_rank = np.cumsum(counts) - 0.5 * (counts + 1)
    return (mean_rank / (values.size - 1)).astype(np.float32)[group].reshape(values.shape)
