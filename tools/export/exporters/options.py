# SPDX-License-Identifier: MIT
"""What a model is built from, and the way to its module."""

import argparse
import importlib
import sys
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Optional

from contract.card import ModelCard
from contract.errors import BAD_USAGE, ExportError


@dataclass(frozen=True)
class BuildOptions:
    """`height` and `width` of the input in pixels; `reduced` keeps a few blocks of each stack, to
    try an exporter in little memory; no `weights`: random ones, always the same."""

    card: ModelCard
    height: int
    width: int
    reduced: bool = False
    weights: Optional[Path] = None
    seed: int = 0


def exporter_module(card: ModelCard, package_path: Optional[Path] = None) -> ModuleType:
    """Imports the exporter of a model, whose package may be in `package_path`."""
    if package_path is not None:
        if not package_path.is_dir():
            raise ExportError(f"--package-path {package_path}: no such folder", BAD_USAGE)
        sys.path.insert(0, str(package_path))
    try:
        importlib.import_module("torch")
        importlib.import_module(card.package)
        return importlib.import_module(f"exporters.{card.module}")
    except ImportError as error:
        raise ExportError(f"{card.name}: Python package missing ({error}); needed: torch, and "
                          f"{card.install}", BAD_USAGE) from error


def add_model_arguments(parser: argparse.ArgumentParser) -> None:
    """What every program that builds a model wants to know about it."""
    group = parser.add_argument_group("model")
    source = group.add_mutually_exclusive_group()
    source.add_argument("--weights", type=Path, metavar="PATH")
    source.add_argument("--random-weights", action="store_true",
                        help="always the same ones: to try an exporter, a pipeline, a cost")
    group.add_argument("--reduced", action="store_true",
                       help="a few blocks of each stack, with random weights only")
    group.add_argument("--package-path", type=Path, metavar="DIR",
                       help="folder that holds the model's Python package")
    group.add_argument("--seed", type=int, default=0, help="of the random weights")


def model_options(arguments: argparse.Namespace, card: ModelCard, height: int,
                  width: int) -> BuildOptions:
    """Checks that the weights are named, and go with the size of the model."""
    if arguments.weights is None and not arguments.random_weights:
        raise ExportError(f"{card.name}: give --weights PATH (from {card.weights}) or "
                          "--random-weights", BAD_USAGE)
    if arguments.weights is not None and arguments.reduced:
        raise ExportError("--reduced: only with --random-weights, weights fit the whole model",
                          BAD_USAGE)
    return BuildOptions(card, height, width, arguments.reduced, arguments.weights, arguments.seed)
