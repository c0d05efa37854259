# SPDX-License-Identifier: MIT
"""Errors of the export programs: one line each, with the exit code the caller sees."""

import contextlib
import errno
import sys
from typing import Callable, Iterator

INTERRUPTED = 1
BAD_USAGE = 2
BAD_INPUT = 3
LIMIT = 4  # also of a device: disk, memory, accelerator

_DISK = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO)


class ExportError(Exception):
    """One line: what, where, what to do. `code` is the exit code of the program."""

    def __init__(self, message: str, code: int = BAD_INPUT):
        super().__init__(message)
        self.code = code


def disk_code(error: OSError) -> int:
    """Exit code where a file cannot be written."""
    return LIMIT if error.errno in _DISK else BAD_INPUT


def say(program: str, line: object) -> None:
    """One line on stderr: what a terminal would take for a command becomes a question mark."""
    text = "".join(char if char.isprintable() else "?" for char in str(line))
    print(f"{program}: {text}", file=sys.stderr)


def missing_package(error: ImportError) -> str:
    return (f"Python package {error.name or 'unknown'} is missing ({error}): pip install -r "
            "requirements-export.txt")


@contextlib.contextmanager
def packages_of(program: str) -> Iterator[None]:
    """Around the imports of a program: a package that is missing ends it with one line."""
    try:
        yield
    except ImportError as error:
        say(program, missing_package(error))
        sys.exit(BAD_USAGE)


def run(program: str, main: Callable[[], int]) -> int:
    """Runs `main`; what it cannot do becomes one line on stderr and an exit code."""
    for stream in (sys.stdout, sys.stderr):
        stream.reconfigure(errors="replace")  # names of files are bytes of any kind
    try:
        return main()
    except ExportError as error:
        say(program, error)
        return error.code
    except ImportError as error:
        say(program, missing_package(error))
        return BAD_USAGE
    except MemoryError:
        say(program, "out of memory")
        return LIMIT
    except KeyboardInterrupt:
        say(program, "interrupted")
        return INTERRUPTED
