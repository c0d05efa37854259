# SPDX-License-Identifier: MIT
"""Which predictions a session asks for: windows of keyframes, and windows around two places."""

from typing import List

from contract.errors import BAD_USAGE, ExportError

FEWEST_NEW = 2  # keyframes that the last, shorter window must add


def windows(keyframes: int, size: int, overlap: int) -> List[List[int]]:
    """Keyframe ids of each window in the order of request, the one at the end included."""
    if not 2 <= size <= 64 or not 0 <= overlap < size:
        raise ExportError(f"--window {size} --overlap {overlap}: the window is 2 to 64 keyframes, "
                          "the overlap is smaller", BAD_USAGE)
    found = []
    first = covered = 0
    while first + size <= keyframes:
        found.append(list(range(first, first + size)))
        covered = first + size
        first = max(covered - overlap, 0)
    if keyframes - covered >= FEWEST_NEW:
        found.append(list(range(first, keyframes)))
    return found


def loop_window(query: int, match: int, keyframes: int, size: int) -> List[int]:
    """`size` / 2 keyframes around each of two places, ascending and without repeats."""
    if not (0 <= match < keyframes and 0 <= query < keyframes):
        raise ExportError(f"--loop {query},{match}: there are keyframes 0 to {keyframes - 1}",
                          BAD_USAGE)
    half = size // 2
    ids = set()
    for place in (query, match):
        first = min(max(place - half // 2, 0), max(keyframes - half, 0))
        ids.update(range(first, min(first + half, keyframes)))
    return sorted(ids)
