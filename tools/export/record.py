#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs a model over a recorded sequence and writes its predictions for `unisim-replay`.

    record.py MODEL SEQUENCE --out FILE.usr --size HxW (--weights PATH | --random-weights)
    record.py FILE.onnx SEQUENCE --out FILE.usr
    unisim-replay SEQUENCE --stride 5 --predictor recorded --predictions FILE.usr --out DIR

With two models, `--windows-by` names the second, which predicts the windows. Exit code 0 done,
2 bad usage or a package that is missing, 3 bad input."""

import argparse
import sys
import time
from pathlib import Path
from typing import List, Optional, Tuple

sys.path.insert(0, str(Path(__file__).resolve().parent))

import numpy as np  # noqa: E402

from contract.card import ModelCard, card_of, check_size  # noqa: E402
from contract.errors import BAD_USAGE, ExportError, run  # noqa: E402
from contract.poses import compose, inverse  # noqa: E402
from contract.validate import MIN_POSE_CONFIDENCE  # noqa: E402
from exporters.cards import CARDS, find_card  # noqa: E402
from exporters.options import add_model_arguments, exporter_module, model_options  # noqa: E402
from exporters.runner import TorchRunner, open_onnx  # noqa: E402
from recording.frames import Frame, list_frames, load  # noqa: E402
from recording.predictor import Predictor, Rejected  # noqa: E402
from recording.schedule import loop_window, windows  # noqa: E402
from unisim_export import parse_size  # noqa: E402
from unisim_record import RecordError, RecordWriter  # noqa: E402


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="record.py", description=__doc__.split("\n")[0])
    parser.add_argument("model", metavar="MODEL|FILE.onnx", help=" ".join(CARDS))
    parser.add_argument("sequence", type=Path, metavar="SEQUENCE")
    parser.add_argument("--out", type=Path, required=True, metavar="FILE.usr")
    parser.add_argument("--windows-by", metavar="FILE.onnx", help="the model of the windows")
    parser.add_argument("--stride", type=int, default=5, help="every N-th frame is a keyframe")
    parser.add_argument("--from", type=int, default=0, dest="first", metavar="A")
    parser.add_argument("--to", type=int, metavar="B", help="frames [A, B)")
    parser.add_argument("--window", type=int, default=16, metavar="W")
    parser.add_argument("--overlap", type=int, default=2, metavar="P")
    parser.add_argument("--min-pose-confidence", type=float, default=MIN_POSE_CONFIDENCE,
                        metavar="P", help="where a model gives one: less is rejected (%(default)s)")
    parser.add_argument("--no-windows", action="store_true", help="pairs only")
    parser.add_argument("--loop", action="append", default=[], metavar="I,J",
                        help="also a window around keyframes I and J; may be repeated")
    parser.add_argument("--size", metavar="HxW", help="of a torch model's input")
    parser.add_argument("--device", default="cpu", help="of a torch model: cpu, cuda")
    parser.add_argument("--provider", help="of an ONNX file, for example CUDAExecutionProvider")
    parser.add_argument("--threads", type=int, default=0)
    add_model_arguments(parser)
    return parser.parse_args()


def open_model(name: str, arguments: argparse.Namespace) -> Tuple[object, ModelCard, Tuple]:
    """Runner, card and input size (H, W) of an ONNX file or of a torch model."""
    if name.endswith(".onnx"):
        runner = open_onnx(Path(name), arguments.threads, arguments.provider)
        card = card_of(runner.metadata, name)
        size = card.size
    else:
        card = find_card(name)
        size = parse_size(arguments.size, card.size)
        check_size(card, *size)
        module = exporter_module(card, arguments.package_path)
        model = module.build(model_options(arguments, card, *size))
        runner = TorchRunner(model, card.outputs, arguments.device, arguments.threads)
    if card.kind == "descriptor":
        raise ExportError(f"{name}: a descriptor predicts no geometry; give a multiview or pair "
                          "model", BAD_USAGE)
    print(f"{card.name} {size[0]}x{size[1]}, licence: {card.license}")
    return runner, card, size


def choose_frames(arguments: argparse.Namespace, frames: List[Frame]) -> List[int]:
    """Indices of the frames that are keyframes."""
    if arguments.stride < 1 or arguments.first < 0:
        raise ExportError("--stride is 1 or more, --from is 0 or more", BAD_USAGE)
    end = len(frames) if arguments.to is None else min(arguments.to, len(frames))
    chosen = list(range(arguments.first, end, arguments.stride))
    if len(chosen) < 2:
        raise ExportError(f"{arguments.sequence}: {len(chosen)} keyframes of {len(frames)} frames; "
                          "lower --stride or widen --from and --to")
    return chosen


def parse_loops(texts: List[str], keyframes: int, size: int) -> List[List[int]]:
    loops = []
    for text in texts:
        parts = text.split(",")
        if len(parts) != 2 or not all(part.isdigit() for part in parts):
            raise ExportError(f"--loop {text}: give two keyframes, for example 80,12", BAD_USAGE)
        loops.append(loop_window(int(parts[0]), int(parts[1]), keyframes, size))
    return loops


def write_pair(record: RecordWriter, predictor: Predictor, i: int) -> Optional[str]:
    try:
        found = predictor.predict([i, i + 1])
    except Rejected as error:
        record.reject_pair(i, i + 1, str(error))
        return str(error)
    T_i_j = compose(inverse(found.poses[0]), found.poses[1])
    record.pair(i, i + 1, T_i_j, *found.depths, *found.confidences, focal_px=found.focal_px)
    return None


def write_window(record: RecordWriter, predictor: Predictor, ids: List[int]) -> Optional[str]:
    try:
        found = predictor.predict(ids)
    except Rejected as error:
        record.reject_window(ids, str(error))
        return str(error)
    record.window(ids, found.poses, found.depths, found.confidences, focal_px=found.focal_px)
    return None


def write_all(record: RecordWriter, pair_model: Predictor, window_model: Predictor,
              keyframes: int, wanted: List[List[int]]) -> List[str]:
    """Predictions in the order in which a session asks for them; the reasons of those rejected."""
    faults = []
    for newest in range(1, keyframes):
        faults.append(write_pair(record, pair_model, newest - 1))
        for ids in (ids for ids in wanted if ids[-1] == newest):
            faults.append(write_window(record, window_model, ids))
        oldest_needed = min((ids[0] for ids in wanted if ids[-1] > newest), default=newest)
        for model in {pair_model, window_model}:
            model.forget_before(min(newest, oldest_needed))
        if sys.stderr.isatty():
            print(f"\rkeyframe {newest + 1} of {keyframes}", end="", file=sys.stderr, flush=True)
    if sys.stderr.isatty():
        print(file=sys.stderr)
    return [reason for reason in faults if reason]


def main() -> int:
    arguments = parse_arguments()
    frames = list_frames(arguments.sequence)
    chosen = choose_frames(arguments, frames)
    wanted = [] if arguments.no_windows else windows(len(chosen), arguments.window,
                                                     arguments.overlap)
    wanted += parse_loops(arguments.loop, len(chosen), arguments.window)
    opened = [open_model(name, arguments)
              for name in (arguments.model, arguments.windows_by) if name]
    if wanted and opened[-1][1].kind == "pair":
        raise ExportError(f"{opened[-1][1].name}: predicts pairs only; add --windows-by FILE.onnx "
                          "or --no-windows", BAD_USAGE)
    image_size = load(frames[chosen[0]].path).shape[:2]

    def load_keyframe(k: int) -> np.ndarray:
        image = load(frames[chosen[k]].path)
        if image.shape[:2] != image_size:
            raise ExportError(f"{frames[chosen[k]].path}: {image.shape[1]}x{image.shape[0]}, the "
                              f"first frame is {image_size[1]}x{image_size[0]}")
        return image

    models = [Predictor(runner, card, size, image_size, load_keyframe,
                        arguments.min_pose_confidence)
              for runner, card, size in opened]
    start = time.monotonic()
    names = "+".join(card.name for _, card, _ in opened)
    try:
        with RecordWriter(str(arguments.out), sequence=arguments.sequence.name, predictor=names,
                          image_size=image_size[::-1], creator="record.py") as record:
            for k, frame in enumerate(chosen):
                record.keyframe(k, frame, frames[frame].timestamp_ns)
            faults = write_all(record, models[0], models[-1], len(chosen), wanted)
    except (OSError, RecordError) as error:
        raise ExportError(f"{arguments.out}: {error}") from error
    print(f"{arguments.out}: {len(chosen)} keyframes, {len(chosen) - 1} pairs, {len(wanted)} "
          f"windows, {len(faults)} rejected, {time.monotonic() - start:.0f} s")
    if faults:
        print(f"first rejection: {faults[0]}")
    return 0


if __name__ == "__main__":
    sys.exit(run("record.py", main))
