#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Exports feed-forward models to ONNX files that libunisim runs, and checks them against torch.

    unisim_export.py MODEL --out FILE.onnx --size HxW (--weights PATH | --random-weights)
    unisim_export.py MODEL --split ... also FILE.encoder.onnx, which is run once per image
    unisim_export.py check MODEL FILE.onnx (--weights PATH | --random-weights) [--golden DIR]
    unisim_export.py list

Exit code 0 done, 2 bad usage or a package that is missing, 3 bad input or a difference beyond
the bound of `check`. Models, licences and measured costs: README.md."""

import argparse
import sys
import time
from pathlib import Path
from typing import List, Tuple

sys.path.insert(0, str(Path(__file__).resolve().parent))

from contract.errors import BAD_INPUT, BAD_USAGE, ExportError, packages_of, run  # noqa: E402

with packages_of("unisim_export.py"):
    from contract.card import check_size, check_split, metadata
    from contract.validate import fault
    from exporters.cards import CARDS, find_card
    from exporters.options import BuildOptions, add_model_arguments, exporter_module
    from exporters.options import model_options

FP32_BOUND = 1e-4


def parse_arguments(arguments: List[str]) -> argparse.Namespace:
    if arguments and arguments[0] == "list":
        return argparse.Namespace(command="list")
    check = bool(arguments) and arguments[0] == "check"
    parser = argparse.ArgumentParser(prog="unisim_export.py" + (" check" if check else ""),
                                     description=__doc__.split("\n")[0])
    parser.add_argument("model", metavar="MODEL", help=" ".join(CARDS))
    if check:
        parser.add_argument("file", type=Path, metavar="FILE.onnx")
        parser.add_argument("--views", default="2,3,16", help="numbers of views to try")
        parser.add_argument("--golden", type=Path, metavar="DIR", help="write outputs of torch")
        parser.add_argument("--threads", type=int, default=0)
        parser.add_argument("--bound", type=float, default=FP32_BOUND)
    else:
        parser.add_argument("--out", type=Path, required=True, metavar="FILE.onnx")
        parser.add_argument("--opset", type=int, default=18)
        numbers = parser.add_mutually_exclusive_group()
        numbers.add_argument("--fp16", action="store_true")
        numbers.add_argument("--int8", action="store_true")
        parser.add_argument("--size", metavar="HxW", help="default: the model's own")
        parser.add_argument("--split", action="store_true",
                            help="the encoder in a file of its own, FILE.encoder.onnx")
    add_model_arguments(parser)
    parsed = parser.parse_args(arguments[1:] if check else arguments)
    parsed.command = "check" if check else "export"
    return parsed


def list_models() -> int:
    for card in CARDS.values():
        height, width = card.size
        products = "yes" if card.products else "no"
        print(f"{card.name:12s} {card.kind:10s} {height}x{width}  products: {products:3s}  "
              f"{card.license}  [{card.weights}]")
    return 0


def parse_size(text: str, default: Tuple[int, int]) -> Tuple[int, int]:
    if text is None:
        return default
    parts = text.lower().split("x")
    if len(parts) != 2 or not all(part.isdigit() for part in parts):
        raise ExportError(f"--size {text}: give HEIGHTxWIDTH, for example 224x308", BAD_USAGE)
    return int(parts[0]), int(parts[1])


def export_model(arguments: argparse.Namespace) -> int:
    card = find_card(arguments.model)
    height, width = parse_size(arguments.size, card.size)
    check_size(card, height, width)
    if arguments.split:
        check_split(card)
    if not arguments.out.resolve().parent.is_dir():
        raise ExportError(f"--out {arguments.out}: its folder does not exist", BAD_USAGE)
    options = model_options(arguments, card, height, width)
    module = exporter_module(card, arguments.package_path)
    from exporters import conversion, parts, precision, weights
    keys = metadata(card, height, width, weights.sha256(options.weights, options.seed))
    start = time.monotonic()
    model = module.build(options)
    files = (parts.split(model, module, options, arguments.out, keys) if arguments.split
             else parts.whole(model, options, arguments.out, keys))
    for part in files:
        conversion.export(part, card.name, module.patches(), arguments.opset)
    if arguments.fp16 or arguments.int8:
        kind = "fp16" if arguments.fp16 else "int8"
        print("\n".join(precision.lower(kind, files, options)))
    parameters = sum(p.numel() for p in model.parameters()) / 1e6
    print(f"{' '.join(str(part.path) for part in files)}: {card.name} {height}x{width}, "
          f"{parameters:.1f} M parameters, {time.monotonic() - start:.0f} s")
    print(f"licence: {card.license}; products: {'yes' if card.products else 'no'}")
    if options.weights is None:
        print("random weights: shapes and costs are real, what it predicts means nothing")
    return 0


def parse_views(text: str, kind: str) -> List[int]:
    if kind != "multiview":
        return [2 if kind == "pair" else 1]
    try:
        return [int(part) for part in text.split(",")]
    except ValueError as error:
        raise ExportError(f"--views {text}: give numbers with commas, for example 2,16",
                          BAD_USAGE) from error


def check_model(arguments: argparse.Namespace) -> int:
    card = find_card(arguments.model)
    all_views = parse_views(arguments.views, card.kind)
    module = exporter_module(card, arguments.package_path)
    from exporters import comparison, parts
    from exporters.runner import TorchRunner, open_onnx
    onnx = open_onnx(arguments.file, arguments.threads)
    if onnx.metadata.get("model") != card.name:
        raise ExportError(f"{arguments.file}: holds {onnx.metadata.get('model')}, not {card.name}")
    height, width = int(onnx.metadata["height"]), int(onnx.metadata["width"])
    options: BuildOptions = model_options(arguments, card, height, width)
    torch = TorchRunner(module.build(options), card.outputs, threads=arguments.threads)
    worst = 0.0
    for views in all_views:
        values = parts.example_input(options, views).numpy()
        expected = torch.run(values)
        wrong = options.weights and card.kind != "descriptor" and fault(expected, 0.0)
        if wrong:
            raise ExportError(f"{card.name}: torch itself gives an unusable prediction: {wrong}")
        differences = comparison.relative_differences(onnx.run(values), expected)
        print("\n".join(comparison.table(views, differences)))
        worst = max(worst, *differences.values())
        if arguments.golden:
            name = f"{card.name}_{height}x{width}_v{views}"
            print(f"golden: {comparison.write_golden(arguments.golden, name, values, expected)}")
    if not worst <= arguments.bound:
        raise ExportError(f"{arguments.file}: differs from torch by {worst:.2e}, more than "
                          f"{arguments.bound:g}; was it exported with the same weights?", BAD_INPUT)
    return 0


def main() -> int:
    arguments = parse_arguments(sys.argv[1:])
    commands = {"list": lambda _: list_models(), "export": export_model, "check": check_model}
    return commands[arguments.command](arguments)


if __name__ == "__main__":
    sys.exit(run("unisim_export.py", main))
