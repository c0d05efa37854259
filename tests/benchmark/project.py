# SPDX-License-Identifier: MIT
"""The tools that are tested, and the programs they call: the last argument of a test is their folder."""
import subprocess
import sys
from pathlib import Path

PROGRAMS = sys.argv.pop() if len(sys.argv) > 1 else "build/release/bin"
TOOLS = Path(__file__).resolve().parents[2] / "tools"
sys.path.insert(0, str(TOOLS))


def run_tool(name, *options):
    return subprocess.run([sys.executable, "-B", str(TOOLS / name), *map(str, options)], capture_output=True, text=True)
