# SPDX-License-Identifier: MIT
"""A network of a few layers from torch to ONNX files: free views, split, fp16, int8."""

import shutil
import unittest
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import setting

setting.require("torch", "onnx", "onnxscript", "onnxruntime")
import numpy as np
import onnx
import torch
from contract.card import metadata
from contract.errors import ExportError
from exporters import conversion, parts, precision
from exporters.cards import find_card
from exporters.comparison import relative_differences
from exporters.options import BuildOptions
from exporters.runner import TorchRunner, open_onnx

HEIGHT, WIDTH, CHANNELS = 28, 42, 32
CARD = replace(find_card("vggt"), name="tiny")
OPTIONS = BuildOptions(CARD, HEIGHT, WIDTH)


class Encoder(torch.nn.Module):
    """Patches of 14 pixels, mixed: (1, V, 3, H, W) to (1, V, N, C)."""

    def __init__(self):
        super().__init__()
        self.embed = torch.nn.Conv2d(3, CHANNELS, 14, 14)
        self.mix = torch.nn.Linear(CHANNELS, CHANNELS)

    def forward(self, images):
        tokens = self.embed(images.flatten(0, 1)).flatten(2).transpose(1, 2)
        return torch.tanh(self.mix(tokens)).unflatten(0, images.shape[:2])


class Rest(torch.nn.Module):
    """Every view sees the mean of all, so that the number of views matters."""

    def __init__(self):
        super().__init__()
        self.out = torch.nn.Linear(CHANNELS, 2 * 14 * 14)

    def forward(self, features):
        views = features.shape[1]
        patches = self.out(features + features.mean(dim=1, keepdim=True))
        patches = patches.reshape(1, views, HEIGHT // 14, WIDTH // 14, 2, 14, 14)
        maps = patches.permute(0, 1, 4, 2, 5, 3, 6).reshape(1, views, 2, HEIGHT, WIDTH)
        pose = torch.cat([torch.eye(3).expand(1, views, 3, 3), maps[:, :, 0, :3, :1]], dim=-1)
        focal = maps[:, :, 1, :3, :3].exp()
        return maps[:, :, 0].exp(), maps[:, :, 1], pose, focal


class Whole(torch.nn.Module):
    def __init__(self):
        super().__init__()
        torch.manual_seed(1)
        self.encoder, self.rest = Encoder(), Rest()

    def forward(self, images):
        return self.rest(self.encoder(images))


EXPORTER = SimpleNamespace(split=lambda whole, options: (whole.encoder, whole.rest))


class Conversion(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = setting.fresh_folder(cls.addClassCleanup)
        cls.model = Whole().eval()
        keys = metadata(CARD, HEIGHT, WIDTH, "random:1")
        cls.whole = parts.whole(cls.model, OPTIONS, cls.folder / "whole.onnx", keys)
        cls.split = parts.split(cls.model, EXPORTER, OPTIONS, cls.folder / "split.onnx", keys)
        for part in cls.whole + cls.split:
            conversion.export(part, CARD.name, [], 18)

    def copied(self, files):
        """The files in a fresh folder, to be changed."""
        folder = setting.fresh_folder(self.addCleanup)
        return [replace(part, path=Path(shutil.copy(part.path, folder))) for part in files]

    def largest_difference(self, path: Path, views: int) -> float:
        values = parts.example_input(OPTIONS, views).numpy()
        expected = TorchRunner(self.model, CARD.outputs).run(values)
        return max(relative_differences(open_onnx(path).run(values), expected).values())

    def test_one_file_takes_any_number_of_views(self):
        for views in (2, 5, 16):
            self.assertLess(self.largest_difference(self.whole[0].path, views), 1e-5)

    def test_encoder_and_rest_in_a_row_give_what_the_whole_gives(self):
        encoder, rest = self.split
        for views in (2, 5):
            self.assertLess(self.largest_difference(rest.path, views), 1e-5)
        given = onnx.load(str(encoder.path)).graph
        self.assertEqual([dim.dim_value for dim in given.input[0].type.tensor_type.shape.dim],
                         [1, 1, 3, HEIGHT, WIDTH])
        self.assertEqual([dim.dim_value for dim in given.output[0].type.tensor_type.shape.dim],
                         [1, 1, 6, CHANNELS])

    def test_each_file_of_a_split_model_holds_its_own_weights_only(self):
        for part in self.split:
            found = sum(len(tensor.raw_data) for tensor in onnx.load(str(part.path))
                        .graph.initializer)
            expected = sum(4 * p.numel() for p in part.module.parameters())
            self.assertLess(found, expected + 1000)

    def test_the_encoder_of_other_weights_is_refused(self):
        encoder, rest = self.copied(self.split)
        conversion.rewrite_metadata(encoder.path, {**encoder.metadata, "unisim.encoder": "0"})
        with self.assertRaisesRegex(ExportError, "split.encoder.onnx: is not the encoder of split"):
            open_onnx(rest.path)

    def test_a_split_model_without_its_encoder_says_what_is_missing(self):
        encoder, rest = self.copied(self.split)
        encoder.path.unlink()
        with self.assertRaisesRegex(ExportError, "put split.encoder.onnx beside it"):
            open_onnx(rest.path)

    def test_an_encoder_alone_is_no_model(self):
        with self.assertRaisesRegex(ExportError, "is an encoder"):
            open_onnx(self.split[0].path)

    def test_lower_precision_stays_near_and_keeps_metadata_and_float_outputs(self):
        for kind, bound in (("fp16", 2e-2), ("int8", 5e-1)):
            for original in (self.whole, self.split):
                files = self.copied(original)
                size = sum(part.path.stat().st_size for part in files)
                lines = precision.lower(kind, files, OPTIONS)
                self.assertEqual(lines[0], f"{kind} against float32:")
                path = files[-1].path
                self.assertLess(self.largest_difference(path, 5), bound, (kind, path.name))
                self.assertGreater(self.largest_difference(path, 5), 1e-6, (kind, path.name))
                self.assertLess(sum(part.path.stat().st_size for part in files), size)
                self.assertEqual(open_onnx(path).metadata["model"], "tiny")
                values = parts.example_input(OPTIONS, 2).numpy()
                for name, found in open_onnx(path).run(values).items():
                    self.assertEqual(found.dtype, np.float32, name)

    def test_an_opset_too_low_is_refused_with_the_lowest(self):
        with self.assertRaisesRegex(ExportError, "--opset 17: 18 is the lowest"):
            conversion.export(self.whole[0], CARD.name, [], 17)


if __name__ == "__main__":
    unittest.main()
