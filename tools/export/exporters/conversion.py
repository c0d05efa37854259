# SPDX-License-Identifier: MIT
"""Torch modules to ONNX files: static size, free number of views."""

import contextlib
import io
import logging
import warnings
from pathlib import Path
from typing import Any, Dict, Iterable

import onnx
import torch

from contract.errors import BAD_USAGE, ExportError
from exporters.parts import Part, dynamic_shapes
from exporters.patching import Patch, patched

LOWEST_OPSET = 18  # lower ones are made by down-conversion and come out invalid
EXTERNAL_BYTES = 1_800_000_000  # a protobuf ends at 2 GB: beyond, the weights lie beside the file


@contextlib.contextmanager
def quiet() -> Any:
    """The progress of other packages goes nowhere: their errors are exceptions."""
    logging.disable(logging.WARNING)
    try:
        with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):
            warnings.simplefilter("ignore")
            yield
    finally:
        logging.disable(logging.NOTSET)


def export(part: Part, name: str, patches: Iterable[Patch], opset: int) -> None:
    """Writes the part's file, and FILE.data beside it when the weights do not fit one file."""
    if opset < LOWEST_OPSET:
        raise ExportError(f"--opset {opset}: {LOWEST_OPSET} is the lowest that works", BAD_USAGE)
    with torch.no_grad(), patched(patches), quiet():
        try:
            program = torch.onnx.export(
                part.module, (part.example,), dynamo=True, opset_version=opset,
                input_names=[part.input], output_names=list(part.outputs),
                dynamic_shapes=dynamic_shapes(part), optimize=True, verbose=False)
        except torch.onnx.OnnxExporterError as error:
            reason = str(error.__cause__ or error).strip().splitlines()[0]
            raise ExportError(f"{name}: torch {torch.__version__} cannot export it: {reason}; "
                              "try the versions of requirements-export.txt") from error
        program.model.metadata_props.update(part.metadata)
        size = sum(value.const_value.nbytes for value in program.model.graph.initializers.values())
        program.save(str(part.path), external_data=size > EXTERNAL_BYTES)


def rewrite_metadata(path: Path, metadata: Dict[str, str]) -> None:
    """Puts the contract's keys into a file that another tool has written anew."""
    model = onnx.load(str(path), load_external_data=False)
    onnx.helper.set_model_props(model, metadata)
    onnx.save(model, str(path))
