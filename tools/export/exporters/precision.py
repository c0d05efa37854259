# SPDX-License-Identifier: MIT
"""Smaller numbers in an exported file: fp16 throughout, or int8 weights of matrix products."""

from pathlib import Path
from typing import List, Sequence

import onnx

from contract.errors import BAD_USAGE, ExportError
from exporters.comparison import relative_differences, table
from exporters.conversion import EXTERNAL_BYTES, quiet, rewrite_metadata
from exporters.options import BuildOptions
from exporters.parts import Part, example_input
from exporters.runner import open_onnx


def _load_plain(path: Path) -> onnx.ModelProto:
    """The model without inferred shapes, which both converters take for truth and trip over."""
    model = onnx.load(str(path))
    del model.graph.value_info[:]
    for index, node in enumerate(model.graph.node):
        node.name = f"n{index}"
    return model


def _check_size(path: Path) -> None:
    data = path.with_name(path.name + ".data")
    if path.stat().st_size + (data.stat().st_size if data.exists() else 0) > EXTERNAL_BYTES:
        raise ExportError(f"{path}: over 2 GB; fp16 and int8 are made of smaller models only, "
                          "take the execution provider's own fp16 for this one", BAD_USAGE)


def _to_fp16(path: Path) -> None:
    """Half precision throughout; inputs and outputs stay float32."""
    from onnxruntime.transformers.float16 import convert_float_to_float16
    onnx.save(convert_float_to_float16(_load_plain(path), keep_io_types=True), str(path))


def _to_int8(path: Path) -> None:
    """8-bit weights of MatMul and Gemm; activations are scaled per call."""
    from onnxruntime.quantization import QuantType, quantize_dynamic
    quantize_dynamic(_load_plain(path), str(path), weight_type=QuantType.QInt8,
                     op_types_to_quantize=["MatMul", "Gemm"])


_CONVERSIONS = {"fp16": _to_fp16, "int8": _to_int8}


def lower(kind: str, files: Sequence[Part], options: BuildOptions) -> List[str]:
    """Rewrites the files of one model, metadata included. Lines that say what it did to the
    outputs."""
    values = example_input(options, 2).numpy()
    last = files[-1].path
    full = open_onnx(last).run(values)
    for part in files:
        _check_size(part.path)
        with quiet():
            _CONVERSIONS[kind](part.path)
        rewrite_metadata(part.path, part.metadata)
    lowered = open_onnx(last).run(values)
    return [f"{kind} against float32:", *table(2, relative_differences(lowered, full))]
