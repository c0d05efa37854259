#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs a model over a recorded sequence and writes its predictions for `unisim-replay`.

    record.py MODEL SEQUENCE --out FILE.usr --size HxW (--weights PATH | --random-weights)
    record.py FILE.onnx SEQUENCE --out FILE.usr
    unisim-replay SEQUENCE --stride 5 --predictor recorded --predictions FILE.usr --out DIR

With two models, `--windows-by` names the second, which predicts the windows. The frames are those
that `unisim-replay --list-frames` lists. Exit code 0 done, 1 interrupted, 2 bad usage or a package
or program that is missing, 3 bad input, 4 disk, memory or inference failed. What was predicted
before stays in the file and can be replayed."""

import argparse
import sys
import time
from pathlib import Path
from typing import List, Optional, Tuple

sys.path.insert(0, str(Path(__file__).resolve().parent))

from contract.errors import BAD_USAGE, ExportError, disk_code, packages_of, run, say  # noqa: E402

with packages_of("record.py"):
    from contract.card import ModelCard, card_of, check_size
    from contract.poses import compose, inverse
    from contract.validate import MIN_POSE_CONFIDENCE
    from exporters.cards import CARDS, find_card
    from exporters.options import add_model_arguments, exporter_module, model_options
    from exporters.runner import TorchRunner, open_onnx
    from recording.frames import Frame, list_frames
    from recording.keyframes import SameSize, choose_keyframes
    from recording.pixels import reader_of
    from recording.predictor import Predictor, Rejected
    from recording.schedule import loop_window, windows
    from unisim_export import parse_size
    from unisim_record import RecordError, RecordWriter


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="record.py", description=__doc__.split("\n")[0])
    parser.add_argument("model", metavar="MODEL|FILE.onnx", help=" ".join(CARDS))
    parser.add_argument("sequence", metavar="SEQUENCE")
    parser.add_argument("--out", type=Path, required=True, metavar="FILE.usr")
    parser.add_argument("--windows-by", metavar="FILE.onnx", help="the model of the windows")
    parser.add_argument("--format", default="auto", help="of the sequence, as of unisim-replay")
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
    parser.add_argument("--unisim-replay", metavar="PATH",
                        help="the program that lists the frames (default: this checkout's build, "
                        "then the one on the path)")
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


def find_keyframes(arguments: argparse.Namespace) -> Tuple[List[Frame], Tuple[int, int]]:
    """Frames that are keyframes, each of which could be read, and their (height, width)."""
    if arguments.stride < 1 or arguments.first < 0:
        raise ExportError("--stride is 1 or more, --from is 0 or more", BAD_USAGE)
    frames = list_frames(arguments.sequence, arguments.first, arguments.to, arguments.format,
                         arguments.unisim_replay)
    load = SameSize(reader_of(frames))
    chosen = choose_keyframes(frames, arguments.stride, load,
                              lambda line: say("record.py", line))
    if len(chosen) < 2:
        raise ExportError(f"{arguments.sequence}: {len(chosen)} keyframes of {len(frames)} frames; "
                          "lower --stride or widen --from and --to")
    return chosen, load.shape[:2]


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
    record.window(ids, found.poses, found.depths, found.confidences, focal_px=found.focal_px,
                  unit=predictor.unit)
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


def record_all(arguments: argparse.Namespace, models: List[Predictor], names: str,
               chosen: List[Frame], image_size: Tuple[int, int],
               wanted: List[List[int]]) -> List[str]:
    """Writes the file; the reasons of what was rejected."""
    sequence = Path(arguments.sequence).name
    try:
        with RecordWriter(str(arguments.out), sequence=sequence, predictor=names,
                          image_size=image_size[::-1], creator="record.py") as record:
            try:
                for k, frame in enumerate(chosen):
                    record.keyframe(k, frame.index, frame.timestamp_ns)
                return write_all(record, models[0], models[-1], len(chosen), wanted)
            except ExportError as error:
                kept = f"{arguments.out} keeps what was predicted before"
                raise ExportError(f"{error}; {kept}", error.code) from error
    except RecordError as error:
        raise ExportError(f"{arguments.out}: {error}") from error
    except OSError as error:
        raise ExportError(f"{arguments.out}: {error.strerror}", disk_code(error)) from error


def main() -> int:
    arguments = parse_arguments()
    chosen, image_size = find_keyframes(arguments)
    wanted = [] if arguments.no_windows else windows(len(chosen), arguments.window,
                                                     arguments.overlap)
    wanted += parse_loops(arguments.loop, len(chosen), arguments.window)
    opened = [open_model(name, arguments)
              for name in (arguments.model, arguments.windows_by) if name]
    if wanted and opened[-1][1].kind == "pair":
        raise ExportError(f"{opened[-1][1].name}: predicts pairs only; add --windows-by FILE.onnx "
                          "or --no-windows", BAD_USAGE)

    def predictor(runner: object, card: ModelCard, size: Tuple[int, int]) -> Predictor:
        load = reader_of(chosen)  # one each: a video is read forward
        return Predictor(runner, card, size, image_size, lambda k: load(chosen[k]),
                         arguments.min_pose_confidence)

    models = [predictor(*parts) for parts in opened]
    start = time.monotonic()
    names = "+".join(card.name for _, card, _ in opened)
    faults = record_all(arguments, models, names, chosen, image_size, wanted)
    print(f"{arguments.out}: {len(chosen)} keyframes, {len(chosen) - 1} pairs, {len(wanted)} "
          f"windows, {len(faults)} rejected, {time.monotonic() - start:.0f} s")
    if faults:
        print(f"first rejection: {faults[0]}")
    return 0


if __name__ == "__main__":
    sys.exit(run("record.py", main))
