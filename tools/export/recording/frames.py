# SPDX-License-Identifier: MIT
"""Frames of a recorded sequence as `unisim-replay` lists them, and their pixels as it sees them."""

import json
import os
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import List, Optional, Tuple

from contract.errors import BAD_INPUT, BAD_USAGE, ExportError

_HERE = Path(__file__).resolve().parent
_PROGRAM = "unisim-replay"


@dataclass(frozen=True)
class Frame:
    """One line of `unisim-replay --list-frames`."""

    index: int
    timestamp_ns: int
    format: str
    path: str
    orientation: int = 1
    bits: int = 16
    stretched: Optional[Tuple[int, int]] = None


def find_program(given: Optional[str]) -> str:
    """unisim-replay: what was given, beside the scripts, in the checkout's build, on the path."""
    if given:
        return given
    beside = [_HERE.parent / _PROGRAM, _HERE.parents[2] / "build" / "release" / "bin" / _PROGRAM]
    for path in beside:
        if os.access(path, os.X_OK) and path.is_file():
            return str(path)
    found = shutil.which(_PROGRAM)
    if found is None:
        raise ExportError(f"{_PROGRAM}, which lists the frames, is not found: build it with "
                          "tools/bootstrap.sh build, or give --unisim-replay PATH", BAD_USAGE)
    return found


def _frame(line: str) -> Frame:
    values = json.loads(line)
    path = values["file"]
    if "file_hex" in values:
        path = os.fsdecode(bytes.fromhex(values["file_hex"]))
    stretched = values.get("stretched")
    return Frame(values["index"], values["time_ns"], values["format"], path,
                 values.get("orientation", 1), values.get("bits", 16),
                 tuple(stretched) if stretched else None)


def list_frames(sequence: str, first: int = 0, end: Optional[int] = None, kind: str = "auto",
                program: Optional[str] = None) -> List[Frame]:
    """Frames [first, end) of a sequence of any format that unisim-replay reads."""
    command = [find_program(program), sequence, "--list-frames", "--format", kind,
               "--from", str(first)] + ([] if end is None else ["--to", str(end)])
    try:
        done = subprocess.run(command, capture_output=True, check=False)
    except OSError as error:
        raise ExportError(f"{command[0]}: cannot be run: {error.strerror}", BAD_USAGE) from error
    notes = os.fsdecode(done.stderr).strip()
    if done.returncode != 0:
        reason = notes.splitlines()[-1] if notes else f"ended with code {done.returncode}"
        code = done.returncode if done.returncode > 0 else BAD_INPUT
        raise ExportError(reason.replace(f"{_PROGRAM}: ", "", 1), code)
    if notes:
        print(notes, file=sys.stderr)
    try:
        frames = [_frame(line) for line in done.stdout.decode().splitlines()]
    except (ValueError, KeyError) as error:
        raise ExportError(f"{command[0]}: its list of frames cannot be read ({error}); give "
                          f"--unisim-replay the one of this checkout", BAD_USAGE) from error
    if not frames:
        raise ExportError(f"{sequence}: has no frames")
    return frames
