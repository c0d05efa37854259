#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes the small models of tests/onnx/models: outputs known in closed form, no weights.

    pip install onnx numpy
    python3 tests/onnx/make_models.py [FOLDER]

The files are part of the repository: a fresh clone's tests need neither this script nor Python.
"""

import pathlib
import sys

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

OPSET = 18
IR_VERSION = 8  # read by every ONNX Runtime from 1.21
MAX_VIEWS = 16
ENCODER = "5c0ffee5"  # identity that the parts of a split model share

# Layout of frames rendered with `unisim-synth --encode`; see tools/synth/README.md.
ROTATION_STEP = 2.0**-22
TRANSLATION_STEP = 2.0**-18
DEPTH_STEP = 2.0**-20
FOCAL_STEP = 2.0**-10
SHARE_STEP = 2.0**-24


class Graph:
    """Nodes in order; every method returns the name of what it makes."""

    def __init__(self) -> None:
        self.nodes: list = []
        self.constants: list = []

    def constant(self, values, dtype=np.float32) -> str:
        name = f"c{len(self.constants)}"
        self.constants.append(numpy_helper.from_array(np.asarray(values, dtype=dtype), name))
        return name

    def op(self, kind: str, *inputs: str, out: str | None = None, **attributes) -> str:
        name = out or f"n{len(self.nodes)}"
        self.nodes.append(helper.make_node(kind, list(inputs), [name], **attributes))
        return name

    def slice(self, x: str, start: int, end: int, axis: int) -> str:
        bounds = [self.constant([v], np.int64) for v in (start, end, axis)]
        return self.op("Slice", x, *bounds)

    def reshape(self, x: str, shape: list[int], out: str | None = None) -> str:
        """0 keeps a dimension, -1 is what is left."""
        return self.op("Reshape", x, self.constant(shape, np.int64), out=out)

    def view_numbers(self, per_view: str) -> str:
        """(1,V,1,1): 0, 1, 2 ... for a tensor of that shape."""
        ones = self.op("Add", self.op("Mul", per_view, self.constant(0)), self.constant(1))
        sums = self.op("CumSum", ones, self.constant(1, np.int64))
        return self.op("Sub", sums, self.constant(1))


def save(path, graph, inputs, outputs, metadata) -> None:
    made = helper.make_graph(
        graph.nodes,
        "unisim-test",
        [helper.make_tensor_value_info(n, TensorProto.FLOAT, s) for n, s in inputs],
        [helper.make_tensor_value_info(n, TensorProto.FLOAT, s) for n, s in outputs],
        graph.constants,
    )
    model = helper.make_model(made, opset_imports=[helper.make_opsetid("", OPSET)])
    model.ir_version = IR_VERSION
    model.producer_name = "unisim tests"
    helper.set_model_props(model, {f"unisim.{k}": str(v) for k, v in metadata.items()})
    onnx.checker.check_model(model)
    onnx.save(model, str(path))


def metadata(kind: str, height: int, width: int) -> dict:
    return {
        "contract": "1",
        "kind": kind,
        "model": f"test {kind}",
        "model_license": "MIT",
        "height": height,
        "width": width,
        "min_views": "2" if kind == "pair" else "1",
        "max_views": "2" if kind == "pair" else str(MAX_VIEWS),
        "multiple": "1",
        "mean": "0 0 0",
        "std": "1 1 1",
        "resize": "stretch",
        "pad_value": "0",
        "confidence": "raw",
        "scale": "relative",
        "shared_scale": "1",
        "reference_view": "none",
        "pixel_center": "0",
        "exporter": "tests/onnx/make_models.py",
        "weights_sha256": "none",
    }


def view_shapes(views, height: int, width: int, features: list[int] | None = None):
    """Inputs and outputs; features: tokens and channels of a model that takes these."""
    return (
        [("features", [1, views, *features])] if features else [("images", [1, views, 3, height, width])],
        [
            ("depth", [1, views, height, width]),
            ("confidence", [1, views, height, width]),
            ("pose", [1, views, 3, 4]),
            ("intrinsics", [1, views, 3, 3]),
        ],
    )


def closed_form(views, height: int, width: int):
    """depth = 1 + mean of the channels; confidence = red; intrinsics fx 40, fy 50, cx 30, cy 20.

    Pose of view k: A B^k stretched by diag(1.1, 0.9, 1.05), centre (1 + k, 2 - k/2, 3), where A turns
    by 90 degrees about x and B^k by 0.1 k about z: any gauge, not orthonormal.
    """
    g = Graph()
    red = g.slice("images", 0, 1, 2)
    g.op("Squeeze", red, g.constant([2], np.int64), out="confidence")
    mean = g.op("ReduceMean", "images", g.constant([2], np.int64), keepdims=0)
    g.op("Add", mean, g.constant(1), out="depth")
    first = g.slice(g.slice(red, 0, 1, 3), 0, 1, 4)
    closed_form_poses(g, g.reshape(first, [1, -1, 1, 1]))
    return g


def closed_form_encoder(width: int, nan_above: float | None = None):
    """A token for each row: red, then the mean of the channels, of each of its pixels.

    With nan_above, all is not a number where the first pixel's red is above it.
    """
    g = Graph()
    red = g.reshape(g.slice("images", 0, 1, 2), [1, 1, -1, width])
    mean = g.op("ReduceMean", "images", g.constant([2], np.int64), keepdims=0)
    both = g.op("Concat", red, mean, axis=3, out=None if nan_above else "features")
    if nan_above:
        bad = g.op("Greater", g.slice(g.slice(red, 0, 1, 2), 0, 1, 3), g.constant(nan_above))
        g.op("Where", bad, g.constant(np.nan), both, out="features")
    return g


def closed_form_of_features(width: int):
    """The model of closed_form() behind closed_form_encoder()."""
    g = Graph()
    g.op("Identity", g.slice("features", 0, width, 3), out="confidence")
    g.op("Add", g.slice("features", width, 2 * width, 3), g.constant(1), out="depth")
    closed_form_poses(g, g.slice(g.slice("features", 0, 1, 2), 0, 1, 3))
    return g


def closed_form_poses(g, per_view: str) -> None:
    """Poses and intrinsics of closed_form(); per_view: any (1,V,1,1)."""
    k = g.view_numbers(per_view)
    angle = g.op("Mul", k, g.constant(0.1))
    c, s = g.op("Cos", angle), g.op("Sin", angle)
    zero = g.op("Mul", k, g.constant(0))
    one = g.op("Add", zero, g.constant(1))
    x = g.op("Add", k, one)
    y = g.op("Sub", g.constant(2), g.op("Mul", k, g.constant(0.5)))
    z = g.op("Add", zero, g.constant(3))
    minus_s = g.op("Neg", s)
    # A B: rows (c -s 0), (0 0 -1), (s c 0).
    minus_one = g.op("Neg", one)
    stretch = g.constant([1.1, 0.9, 1.05, 1.0])
    rows = [[c, minus_s, zero, x], [zero, zero, minus_one, y], [s, c, zero, z]]
    parts = [g.op("Mul", g.op("Concat", *row, axis=3), stretch) for row in rows]
    g.op("Concat", *parts, axis=2, out="pose")
    K = g.constant([[[[40, 0, 30], [0, 50, 20], [0, 0, 1]]]])
    ones = g.op("Expand", one, g.constant([1, 1, 3, 3], np.int64))
    g.op("Mul", ones, K, out="intrinsics")


def whole_numbers(g, out: str | None = None) -> str:
    """(1,V,3,H,W) of x/255 to whole numbers of 24 bits (1,V,H,W): red is the high byte."""
    whole = g.op("Round", g.op("Mul", "images", g.constant(255)))
    weights = g.constant([65536, 256, 1])
    weights = g.reshape(weights, [1, 1, 3, 1, 1])
    return g.op("ReduceSum", g.op("Mul", whole, weights), g.constant([2], np.int64), out=out, keepdims=0)


def decoder_encoder():
    """The part of decoder() that sees one image."""
    g = Graph()
    whole_numbers(g, "features")
    return g


def decoder(height: int, width: int, nan_above: float | None = None, nan_of: str = "first", split: bool = False):
    """Reads depth and pose out of frames rendered with `unisim-synth --encode`.

    Every inference is in a unit of its own: lengths are multiplied by
    exp(spread sqrt(2) sin(2 pi sum_k (k + 1) share_k)), share and spread written in the frames.
    With nan_above, depth is not a number where the share of the first view, or of any, is above it: a
    network that a place in the window or one image upsets. Split, it takes the features of
    decoder_encoder().
    """
    g = Graph()
    number = "features" if split else whole_numbers(g)
    header = g.slice(number, 0, 1, 2)  # (1,V,1,W)

    def field(first: int, count: int, step: float, offset: float) -> str:
        raw = g.slice(header, first, first + count, 3)
        return g.op("Add", g.op("Mul", raw, g.constant(step)), g.constant(offset))

    rotation = g.reshape(field(0, 9, ROTATION_STEP, -2), [0, -1, 3, 3])
    centre = g.reshape(field(9, 3, TRANSLATION_STEP, -32), [0, -1, 3, 1])
    focal = field(12, 1, FOCAL_STEP, 0)  # (1,V,1,1)
    share = field(13, 1, SHARE_STEP, 0)
    spread = field(14, 1, SHARE_STEP, 0)
    place = g.op("Add", g.view_numbers(share), g.constant(1))
    turns = g.op("ReduceSum", g.op("Mul", place, share), g.constant([1], np.int64), keepdims=1)
    wave = g.op("Sin", g.op("Mul", turns, g.constant(2 * np.pi)))
    first_spread = g.slice(spread, 0, 1, 1)
    unit = g.op("Exp", g.op("Mul", g.op("Mul", wave, first_spread), g.constant(np.sqrt(2))))

    # The header's row has no depth of its own: it repeats the one below.
    below = g.slice(number, 1, height, 2)
    full = g.op("Concat", g.slice(below, 0, 1, 2), below, axis=2)
    depth = g.op("Mul", g.op("Mul", full, g.constant(DEPTH_STEP)), unit)
    if nan_above is None:
        g.op("Identity", depth, out="depth")
    else:
        upset = g.slice(share, 0, 1, 1)
        if nan_of == "any":
            upset = g.op("ReduceMax", share, g.constant([1], np.int64), keepdims=1)
        bad = g.op("Greater", upset, g.constant(nan_above))
        g.op("Where", bad, g.constant(np.nan), depth, out="depth")
    g.op("Add", g.op("Mul", full, g.constant(0)), g.constant(1), out="confidence")
    g.op("Concat", rotation, g.op("Mul", centre, unit), axis=3, out="pose")
    scale = g.constant([[[[1, 0, 0], [0, 1, 0], [0, 0, 0]]]])
    fixed = g.constant([[[[0, 0, (width - 1) / 2], [0, 0, (height - 1) / 2], [0, 0, 1]]]])
    g.op("Add", g.op("Mul", focal, scale), fixed, out="intrinsics")
    return g


def descriptor(height: int, width: int):
    """Twice the mean of each channel, then 1: not of unit length, the runtime sees to that."""
    g = Graph()
    mean = g.op("ReduceMean", "image", g.constant([2, 3], np.int64), keepdims=0)
    twice = g.op("Mul", mean, g.constant(2))
    g.op("Concat", twice, g.constant([[1]]), axis=1, out="descriptor")
    return g


def make_split_models(folder, h: int, w: int) -> None:
    """Models in two files, X.onnx and X.encoder.onnx; some that do not go together."""

    def encoder(name, graph, rows, columns, tokens, channels):
        inputs = [("images", [1, 1, 3, rows, columns])]
        about = metadata("encoder", rows, columns) | {"encoder": ENCODER}
        save(folder / name, graph, inputs, [("features", [1, 1, tokens, channels])], about)

    def of_features(name, graph, kind, views, rows, columns, tokens, channels, **changes):
        about = metadata(kind, rows, columns) | {"input": "features", "encoder": ENCODER} | changes
        save(folder / name, graph, *view_shapes(views, rows, columns, [tokens, channels]), about)

    encoder("split.encoder.onnx", closed_form_encoder(w), h, w, h, 2 * w)
    encoder("split_nan.encoder.onnx", closed_form_encoder(w, 0.9), h, w, h, 2 * w)
    encoder("decoder_split.encoder.onnx", decoder_encoder(), 48, 64, 48, 64)
    of_features("split.onnx", closed_form_of_features(w), "multiview", "V", h, w, h, 2 * w)
    of_features("split_pair.onnx", closed_form_of_features(w), "pair", 2, h, w, h, 2 * w)
    of_features("decoder_split.onnx", decoder(48, 64, split=True), "multiview", "V", 48, 64, 48, 64)
    of_features("split_other.onnx", closed_form_of_features(w), "multiview", "V", h, w, h, 2 * w, encoder="bad1")
    of_features("split_mean.onnx", closed_form_of_features(w), "multiview", "V", h, w, h, 2 * w, mean="0 0 1")
    of_features("split_shape.onnx", closed_form_of_features(w), "multiview", "V", h, w, h, 2 * w + 1)


def main() -> int:
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent / "models")
    folder.mkdir(parents=True, exist_ok=True)
    h, w = 12, 16

    def views_model(name, graph, kind, views, rows, columns, **changes):
        inputs, outputs = view_shapes(views, rows, columns)
        about = metadata(kind, rows, columns)
        about.update(changes)
        save(folder / name, graph, inputs, outputs, about)

    views_model("multiview.onnx", closed_form("V", h, w), "multiview", "V", h, w)
    views_model("pair.onnx", closed_form(2, h, w), "pair", 2, h, w)
    views_model("eight_views.onnx", closed_form(8, h, w), "multiview", 8, h, w, min_views=8, max_views=8)
    views_model("decoder.onnx", decoder(48, 64), "multiview", "V", 48, 64)
    views_model(
        "peak_stated.onnx",
        closed_form("V", h, w),
        "multiview",
        "V",
        h,
        w,
        peak_bytes=f"2:{1 << 20} 16:{1 << 30}",
    )
    make_split_models(folder, h, w)
    views_model("decoder_nan.onnx", decoder(48, 64, 0.9), "multiview", "V", 48, 64)
    views_model("decoder_nan_any.onnx", decoder(48, 64, 0.9, "any"), "multiview", "V", 48, 64)
    views_model("decoder_nan_rare.onnx", decoder(48, 64, 0.98, "any"), "multiview", "V", 48, 64)
    save(
        folder / "descriptor.onnx",
        descriptor(h, w),
        [("image", [1, 3, h, w])],
        [("descriptor", [1, 4])],
        metadata("descriptor", h, w),
    )
    # Broken in one way each.
    views_model("wrong_size.onnx", closed_form("V", h, w), "multiview", "V", h, w, height=14)
    save(folder / "no_metadata.onnx", closed_form("V", h, w), *view_shapes("V", h, w), {})
    inputs, outputs = view_shapes("V", h, w)
    save(folder / "no_pose.onnx", closed_form("V", h, w), inputs, outputs[:2], metadata("multiview", h, w))
    return 0


if __name__ == "__main__":
    sys.exit(main())
