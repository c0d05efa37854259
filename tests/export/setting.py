# SPDX-License-Identifier: MIT
"""Puts tools/export on the path; without numpy the test says "skipped" and ends."""

import sys
from pathlib import Path

TOOLS = Path(__file__).resolve().parents[2] / "tools" / "export"
sys.path.insert(0, str(TOOLS))

try:
    import numpy  # noqa: F401
except ImportError:
    print("skipped: Python has no numpy")
    sys.exit(0)
