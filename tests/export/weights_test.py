# SPDX-License-Identifier: MIT
"""Weight files: what fits a model, and what is refused by name."""

import unittest

import setting

setting.require("torch", "safetensors")
import torch
from contract.errors import ExportError
from exporters import weights
from safetensors.torch import save_file


class Model(torch.nn.Module):
    """One of its layers has two names."""

    def __init__(self):
        super().__init__()
        self.first = torch.nn.Linear(2, 2)
        self.head = torch.nn.Linear(2, 1)
        self.alias = torch.nn.Sequential(self.head)


class Weights(unittest.TestCase):
    def setUp(self):
        self.path = setting.fresh_folder(self.addCleanup) / "w.safetensors"
        self.state = {f"{layer}.{name}": value.clone()
                      for layer, module in (("first", torch.nn.Linear(2, 2)),
                                            ("head", torch.nn.Linear(2, 1)))
                      for name, value in module.state_dict().items()}

    def test_a_layer_with_two_names_is_stored_once(self):
        save_file(self.state, str(self.path))
        model = Model()
        weights.load(model, self.path)
        self.assertTrue(torch.equal(model.alias[0].weight, self.state["head.weight"]))
        self.assertTrue(torch.equal(model.first.bias, self.state["first.bias"]))

    def test_a_missing_parameter_is_named(self):
        del self.state["first.bias"]
        save_file(self.state, str(self.path))
        with self.assertRaisesRegex(ExportError, "lacks first.bias"):
            weights.load(Model(), self.path)

    def test_a_foreign_parameter_is_named_unless_its_head_is_not_exported(self):
        save_file({**self.state, "track.weight": torch.ones(1)}, str(self.path))
        with self.assertRaisesRegex(ExportError, "has track.weight"):
            weights.load(Model(), self.path)
        weights.load(Model(), self.path, ignored=("track.",))

    def test_random_weights_are_always_the_same(self):
        first, second = Model(), Model()
        for model in (first, second):
            weights.fill(model, None, 3)
        for a, b in zip(first.parameters(), second.parameters()):
            self.assertTrue(torch.equal(a, b))


if __name__ == "__main__":
    unittest.main()
