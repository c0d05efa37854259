#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Time and memory of one call of an exported model, each number of views in a process of its own.

    measure.py FILE.onnx [--views 2,16] [--threads 1] [--repeat 3]

Prints the least CPU time of the calls after the first, and the peak memory of the process,
Python and the runtime included. The two files of a split model are measured one by one."""

import argparse
import resource
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

from contract.errors import BAD_USAGE, ExportError, packages_of, run  # noqa: E402

with packages_of("measure.py"):
    import numpy as np
    from exporters.runner import OnnxRunner


def measure_here(path: Path, views: int, threads: int, repeat: int) -> int:
    """Runs the model in this process and prints one line."""
    start = time.process_time()
    runner = OnnxRunner(path, threads)
    load_s = time.process_time() - start
    keys = runner.metadata
    shape = list(runner.input_shape)
    if keys["kind"] in ("multiview", "pair"):
        shape[1] = views
    else:
        views = 1
    values = np.random.default_rng(0).random(shape, dtype=np.float32)
    times = []
    for _ in range(1 + repeat):
        start = time.process_time()
        runner.run(values)
        times.append(time.process_time() - start)
    peak_mb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"{keys['model']} {keys['kind']} {keys['height']}x{keys['width']} views {views:2d}: "
          f"load {load_s:.2f} s, call {min(times[1:] or times):.2f} s CPU, peak {peak_mb:.0f} MB",
          flush=True)
    return 0


def main() -> int:
    parser = argparse.ArgumentParser(prog="measure.py", description=__doc__.split("\n")[0])
    parser.add_argument("file", type=Path, metavar="FILE.onnx")
    parser.add_argument("--views", default="2,16")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--here", action="store_true", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    views = arguments.views.split(",")
    if not all(text.isdigit() for text in views):
        raise ExportError(f"--views {arguments.views}: give numbers with commas", BAD_USAGE)
    if arguments.here:
        return measure_here(arguments.file, int(views[0]), arguments.threads, arguments.repeat)
    for count in views:
        command = [sys.executable, __file__, str(arguments.file), "--here", "--views", count,
                   "--threads", str(arguments.threads), "--repeat", str(arguments.repeat)]
        done = subprocess.run(command, check=False, stdout=subprocess.PIPE, text=True)
        print(done.stdout, end="", flush=True)
        if done.returncode != 0:
            return done.returncode
        if " multiview " not in done.stdout:
            break  # its number of views is fixed
    return 0


if __name__ == "__main__":
    sys.exit(run("measure.py", main))
