# SPDX-License-Identifier: MIT
"""Puts tools/export on the path; where a package is missing the test says "skipped" and ends."""

import importlib.util
import sys
import tempfile
from pathlib import Path

TOOLS = Path(__file__).resolve().parents[2] / "tools" / "export"
sys.path.insert(0, str(TOOLS))


def require(*packages: str) -> None:
    """Ends the program where one of the packages is not installed."""
    for package in packages:
        if importlib.util.find_spec(package) is None:
            print(f"skipped: Python has no {package}")
            sys.exit(0)


def fresh_folder(add_cleanup) -> Path:
    """A new folder; `add_cleanup` is the addCleanup or addClassCleanup that removes it."""
    holder = tempfile.TemporaryDirectory()
    add_cleanup(holder.cleanup)
    return Path(holder.name)


require("numpy")
