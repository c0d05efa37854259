# SPDX-License-Identifier: MIT
"""Replaces attributes of a model's package for as long as an export takes."""

from contextlib import contextmanager
from typing import Any, Iterable, Iterator, Tuple

Patch = Tuple[Any, str, Any]


@contextmanager
def patched(patches: Iterable[Patch]) -> Iterator[None]:
    """Sets object.attribute = replacement, and back at the end whatever happens."""
    before = []
    try:
        for target, attribute, replacement in patches:
            before.append((target, attribute, getattr(target, attribute)))
            setattr(target, attribute, replacement)
        yield
    finally:
        for target, attribute, original in reversed(before):
            setattr(target, attribute, original)
