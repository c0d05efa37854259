# SPDX-License-Identifier: MIT
"""A torch model behind the contract to an ONNX file: static size, dynamic number of views."""

import contextlib
import io
import logging
import warnings
from pathlib import Path
from typing import Any, Dict, Iterable

import onnx
import torch

from contract.card import MAX_VIEWS
from contract.errors import BAD_USAGE, ExportError
from exporters.options import BuildOptions
from exporters.patching import Patch, patched

LOWEST_OPSET = 18  # lower ones are made by down-conversion and come out invalid
EXTERNAL_BYTES = 1_800_000_000  # a protobuf ends at 2 GB: beyond, the weights lie beside the file
_EXAMPLE_VIEWS = 3  # neither 1 nor 2, which tracing would take for constants


def example_input(options: BuildOptions, views: int, seed: int = 0) -> torch.Tensor:
    """Smooth random images as the model wants them: (1, V, 3, H, W), or (1, 3, H, W)."""
    generator = torch.Generator().manual_seed(seed)
    coarse = torch.rand((views, 3, 7, 9), generator=generator)
    images = torch.nn.functional.interpolate(coarse, size=(options.height, options.width),
                                             mode="bilinear", align_corners=False)
    card = options.card
    mean = torch.tensor(card.mean).reshape(1, 3, 1, 1)
    std = torch.tensor(card.std).reshape(1, 3, 1, 1)
    images = (images - mean) / std
    return images[:1] if card.kind == "descriptor" else images.unsqueeze(0)


@contextlib.contextmanager
def _quiet() -> Any:
    """The exporter's own progress goes nowhere: its errors are exceptions."""
    logging.disable(logging.WARNING)
    try:
        with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):
            warnings.simplefilter("ignore")
            yield
    finally:
        logging.disable(logging.NOTSET)


def export(model: torch.nn.Module, options: BuildOptions, patches: Iterable[Patch], opset: int,
           out: Path, metadata: Dict[str, str]) -> None:
    """Writes `out`, and `out`.data beside it when the weights do not fit one file."""
    if opset < LOWEST_OPSET:
        raise ExportError(f"--opset {opset}: {LOWEST_OPSET} is the lowest that works", BAD_USAGE)
    card = options.card
    views = 2 if card.kind == "pair" else _EXAMPLE_VIEWS
    shapes = None
    if card.kind == "multiview":
        shapes = ({1: torch.export.Dim("views", min=2, max=MAX_VIEWS)},)
    with torch.no_grad(), patched(patches), _quiet():
        try:
            program = torch.onnx.export(
                model, (example_input(options, views),), dynamo=True, opset_version=opset,
                input_names=[card.input], output_names=list(card.outputs), dynamic_shapes=shapes,
                optimize=True, verbose=False)
        except torch.onnx.OnnxExporterError as error:
            raise ExportError(f"{card.name}: torch {torch.__version__} cannot export it: "
                              f"{str(error).strip().splitlines()[0]}") from error
        program.model.metadata_props.update(metadata)
        size = sum(p.numel() * p.element_size() for p in model.parameters())
        program.save(str(out), external_data=size > EXTERNAL_BYTES)


def rewrite_metadata(path: Path, metadata: Dict[str, str]) -> None:
    """Puts the contract's keys into a file that another tool has written anew."""
    model = onnx.load(str(path), load_external_data=False)
    onnx.helper.set_model_props(model, metadata)
    onnx.save(model, str(path))
