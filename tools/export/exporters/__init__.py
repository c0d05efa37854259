# SPDX-License-Identifier: MIT
"""One module per model: imports the model's own package and gives it the shape of the contract.

Each module defines

    build(options: BuildOptions) -> torch.nn.Module
        the model as its authors wrote it, behind a forward() from the contract's input to the
        tuple of its outputs (`ModelCard.outputs`);
    patches() -> list of (object, attribute, replacement)
        what has to be replaced, while exporting only, because ONNX cannot say it."""
