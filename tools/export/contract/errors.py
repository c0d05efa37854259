# SPDX-License-Identifier: MIT
"""Errors of the export programs: one line each, with the exit code the caller sees."""

import sys
from typing import Callable

BAD_USAGE = 2
BAD_INPUT = 3


class ExportError(Exception):
    """One line: what, where, what to do. `code` is the exit code of the program."""

    def __init__(self, message: str, code: int = BAD_INPUT):
        super().__init__(message)
        self.code = code


def run(program: str, main: Callable[[], int]) -> int:
    """Runs `main`; what it cannot do becomes one line on stderr and an exit code."""
    try:
        return main()
    except ExportError as error:
        print(f"{program}: {error}", file=sys.stderr)
        return error.code
    except ModuleNotFoundError as error:
        print(f"{program}: Python package {error.name} is missing: pip install -r "
              "requirements-export.txt", file=sys.stderr)
        return BAD_USAGE
