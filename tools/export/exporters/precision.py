# SPDX-License-Identifier: MIT
"""Smaller numbers in an exported file: fp16 throughout, or int8 weights of matrix products."""

from pathlib import Path
from typing import Dict

import onnx

from contract.errors import BAD_USAGE, ExportError
from exporters.conversion import EXTERNAL_BYTES, rewrite_metadata


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


def to_fp16(path: Path, metadata: Dict[str, str]) -> None:
    """Rewrites the file in half precision; inputs and outputs stay float32."""
    from onnxruntime.transformers.float16 import convert_float_to_float16
    _check_size(path)
    model = convert_float_to_float16(_load_plain(path), keep_io_types=True)
    onnx.save(model, str(path))
    rewrite_metadata(path, metadata)


def to_int8(path: Path, metadata: Dict[str, str]) -> None:
    """Rewrites the file with 8-bit weights of MatMul and Gemm; activations are scaled per call."""
    from onnxruntime.quantization import QuantType, quantize_dynamic
    _check_size(path)
    quantize_dynamic(_load_plain(path), str(path), weight_type=QuantType.QInt8,
                     op_types_to_quantize=["MatMul", "Gemm"])
    rewrite_metadata(path, metadata)
