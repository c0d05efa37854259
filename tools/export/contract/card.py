# SPDX-License-Identifier: MIT
"""What is said of a model in the metadata of its ONNX file (keys `unisim.*`)."""

from dataclasses import dataclass
from pathlib import Path
from typing import Dict, Mapping, Tuple

from contract.errors import BAD_INPUT, BAD_USAGE, ExportError

CONTRACT_VERSION = "1"
EXPORTER = "unisim_export 1"
MAX_VIEWS = 64

IMAGENET_MEAN = (0.485, 0.456, 0.406)
IMAGENET_STD = (0.229, 0.224, 0.225)

_OF_GEOMETRY = ("min_views", "max_views", "confidence", "scale", "shared_scale", "reference_view",
                "pixel_center")
_CHOICES = {
    "kind": ("multiview", "pair", "descriptor", "encoder"),
    "resize": ("fit", "crop", "pad", "stretch"),
    "confidence": ("expp1", "sigmoid", "raw"),
    "scale": ("relative", "metric"),
    "reference_view": ("0", "none"),
    "pixel_center": ("0", "0.5"),
}


@dataclass(frozen=True)
class ModelCard:
    """Facts of one model that do not depend on how it is exported.

    `mean` and `std` are those the file's input wants: identity where the graph normalises itself.
    `size` (height, width) is what the model was trained for, or near it."""

    name: str
    module: str  # of exporters/
    package: str  # Python package that holds the model
    install: str  # how to get it
    weights: str  # where its weights are
    license: str  # of the weights, as its authors name it
    products: bool  # may a product ship it?
    kind: str = "multiview"
    multiple: int = 14
    size: Tuple[int, int] = (392, 518)
    mean: Tuple[float, float, float] = (0.0, 0.0, 0.0)
    std: Tuple[float, float, float] = (1.0, 1.0, 1.0)
    resize: str = "fit"
    pad_value: float = 0.0
    confidence: str = "expp1"
    scale: str = "relative"
    reference_view: str = "0"
    pixel_center: str = "0.5"
    unsplit: str = ""  # why its encoder cannot be a file of its own; empty: it can

    def __post_init__(self) -> None:
        for field, known in _CHOICES.items():
            if getattr(self, field) not in known:
                raise ValueError(f"{self.name}: {field} is {getattr(self, field)}, not of {known}")

    @property
    def outputs(self) -> Tuple[str, ...]:
        """Names of the outputs in the order in which the torch wrapper returns them."""
        if self.kind == "descriptor":
            return ("descriptor",)
        extra = ("pose_confidence",) if self.kind == "pair" else ()
        return ("depth", "confidence", "pose", "intrinsics") + extra

    @property
    def input(self) -> str:
        return "image" if self.kind == "descriptor" else "images"


def check_size(card: ModelCard, height: int, width: int) -> None:
    """Refuses a size that the model's patches do not divide."""
    if height < 1 or width < 1 or height % card.multiple or width % card.multiple:
        raise ExportError(f"--size {height}x{width}: {card.name} wants multiples of "
                          f"{card.multiple}, for example {card.size[0]}x{card.size[1]}", BAD_USAGE)


def check_split(card: ModelCard) -> None:
    """Refuses a model whose encoder cannot be a file of its own."""
    if card.unsplit:
        raise ExportError(f"--split: not for {card.name}: {card.unsplit}", BAD_USAGE)


def _numbers(values: Tuple[float, ...]) -> str:
    return " ".join(f"{value:g}" for value in values)


def metadata(card: ModelCard, height: int, width: int, weights_sha256: str) -> Dict[str, str]:
    """All keys of the contract, as strings, for a file of one input size."""
    values = {
        "contract": CONTRACT_VERSION, "kind": card.kind, "model": card.name,
        "model_license": card.license, "height": str(height), "width": str(width),
        "multiple": str(card.multiple), "mean": _numbers(card.mean), "std": _numbers(card.std),
        "resize": card.resize, "pad_value": f"{card.pad_value:g}", "exporter": EXPORTER,
        "weights_sha256": weights_sha256,
    }
    if card.kind != "descriptor":
        views = 2 if card.kind == "pair" else MAX_VIEWS
        values.update({
            "min_views": "2", "max_views": str(views), "confidence": card.confidence,
            "scale": card.scale, "shared_scale": "1", "reference_view": card.reference_view,
            "pixel_center": card.pixel_center,
        })
    return {f"unisim.{key}": value for key, value in values.items()}


def encoder_path(path: Path) -> Path:
    """FILE.encoder.onnx of FILE.onnx."""
    return path.with_name(f"{path.stem}.encoder{path.suffix}")


def split_metadata(keys: Mapping[str, str], identity: str) -> Tuple[Dict[str, str], Dict[str, str]]:
    """Keys of an encoder's file and of the file that takes its features, from those of the whole.

    `identity` stands in both, so that features of other weights or another size are refused."""
    encoder = {key: value for key, value in keys.items()
               if key[len("unisim."):] not in _OF_GEOMETRY}
    encoder.update({"unisim.kind": "encoder", "unisim.encoder": identity})
    return encoder, {**keys, "unisim.input": "features", "unisim.encoder": identity}


def card_of(keys: Mapping[str, str], path: str) -> ModelCard:
    """The card of a file with these keys (without `unisim.`), whoever exported it."""
    try:
        triples = {key: tuple(float(text) for text in keys[key].split()) for key in ("mean", "std")}
        if any(len(values) != 3 for values in triples.values()):
            raise ValueError("mean and std are three numbers each")
        optional = {key: keys[key] for key in ("confidence", "scale", "reference_view",
                                               "pixel_center") if key in keys}
        return ModelCard(
            name=keys["model"], module="", package="", install="", weights="",
            license=keys["model_license"], products=False, kind=keys["kind"],
            multiple=int(keys["multiple"]), size=(int(keys["height"]), int(keys["width"])),
            resize=keys["resize"], pad_value=float(keys.get("pad_value", "0")), **triples,
            **optional)
    except (KeyError, ValueError) as error:
        raise ExportError(f"{path}: metadata unisim.*: {error}; export the model anew",
                          BAD_INPUT) from error
