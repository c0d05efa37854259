# SPDX-License-Identifier: MIT
"""A model that takes the contract's input and gives its named outputs: torch, or an ONNX file."""

from pathlib import Path
from typing import Dict, Optional

import numpy as np

from contract.card import encoder_path
from contract.errors import LIMIT, ExportError

Outputs = Dict[str, np.ndarray]


class TorchRunner:
    """The model as its authors wrote it."""

    def __init__(self, model, output_names, device: str = "cpu", threads: int = 0):
        import torch
        if threads > 0:
            torch.set_num_threads(threads)
        self._torch = torch
        self._device = device
        self._model = model.to(device)
        self._names = output_names

    def run(self, values: np.ndarray) -> Outputs:
        with self._torch.inference_mode():
            given = self._torch.from_numpy(values).to(self._device)
            found = self._model(given)
            found = found if isinstance(found, tuple) else (found,)
            return {name: value.float().cpu().numpy()
                    for name, value in zip(self._names, found)}


class OnnxRunner:
    """A file that `unisim_export.py` wrote; `metadata` has its keys without `unisim.`."""

    def __init__(self, path: Path, threads: int = 0, provider: Optional[str] = None):
        import onnxruntime
        self._path = path
        settings = onnxruntime.SessionOptions()
        settings.intra_op_num_threads = threads
        settings.log_severity_level = 3
        providers = [provider or "CPUExecutionProvider"]
        try:
            self._session = onnxruntime.InferenceSession(str(path), settings, providers=providers)
        except Exception as error:  # the runtime's own error types have no common base
            reason = str(error).splitlines()[0]
            raise ExportError(f"{path}: cannot be loaded: {reason}") from error
        keys = self._session.get_modelmeta().custom_metadata_map
        self.metadata = {key[len("unisim."):]: value for key, value in keys.items()
                         if key.startswith("unisim.")}
        if "contract" not in self.metadata:
            raise ExportError(f"{path}: no unisim.contract in its metadata; export the model with "
                              "unisim_export.py")
        self._input = self._session.get_inputs()[0].name
        self.input_shape = self._session.get_inputs()[0].shape
        self._names = [output.name for output in self._session.get_outputs()]

    def run(self, values: np.ndarray) -> Outputs:
        try:
            found = self._session.run(None, {self._input: values})
        except Exception as error:  # the runtime's own error types have no common base
            reason = str(error).splitlines()[0]
            raise ExportError(f"{self._path}: inference failed: {reason}", LIMIT) from error
        return dict(zip(self._names, found))


class SplitRunner:
    """A file that takes features, behind its encoder: together they take images."""

    def __init__(self, encoder: OnnxRunner, rest: OnnxRunner):
        self.metadata = rest.metadata
        self._encoder = encoder
        self._rest = rest

    def run(self, values: np.ndarray) -> Outputs:
        features = [self._encoder.run(values[:, k:k + 1])["features"]
                    for k in range(values.shape[1])]
        return self._rest.run(np.concatenate(features, axis=1))


def open_onnx(path: Path, threads: int = 0, provider: Optional[str] = None):
    """The runner of a file, with the encoder that lies beside it where it needs one."""
    runner = OnnxRunner(path, threads, provider)
    if runner.metadata.get("kind") == "encoder":
        raise ExportError(f"{path}: is an encoder, which predicts nothing by itself; give the file "
                          "it belongs to")
    if runner.metadata.get("input", "images") != "features":
        return runner
    beside = encoder_path(path)
    if not beside.is_file():
        raise ExportError(f"{path}: takes the features of an encoder; put {beside.name} beside it")
    encoder = OnnxRunner(beside, threads, provider)
    if encoder.metadata.get("encoder") != runner.metadata.get("encoder"):
        raise ExportError(f"{beside}: is not the encoder of {path.name} (other weights or another "
                          "size); export the two together")
    return SplitRunner(encoder, runner)
