// SPDX-License-Identifier: MIT
// Inputs and outputs of a network against the shapes of the model contract.
#include "drivers/onnx/runtime/tensor_check.hpp"

#include <algorithm>
#include <cstring>

#include "drivers/onnx/error.hpp"

namespace unisim::onnx {
namespace {

[[noreturn]] void fail(const Network& network, const std::string& what) {
  throw OnnxError(UNISIM_ONNX_BAD_MODEL, network.path() + ": " + what);
}

/// Could a tensor declared like this have that shape?
bool admits(const std::vector<int64_t>& declared, const std::vector<int64_t>& wanted) {
  if (declared.size() != wanted.size()) return false;
  for (size_t i = 0; i < wanted.size(); ++i) {
    if (declared[i] >= 0 && wanted[i] >= 0 && declared[i] != wanted[i]) return false;
  }
  return true;
}

void require_shape(const Network& network, const std::string& what, const TensorInfo& tensor,
                   const std::vector<int64_t>& shape) {
  const bool is_float = std::strcmp(tensor.type, "float32") == 0;
  if (is_float && admits(tensor.shape, shape)) return;
  const std::string found = is_float ? "shape " : std::string("type ") + tensor.type + ", shape ";
  fail(network, what + " " + tensor.name + " has " + found + shape_text(tensor.shape) +
                    ", the contract wants float32 " + shape_text(shape) +
                    (is_float ? "" : "; export it with float32 inputs and outputs"));
}

}  // namespace

std::string shape_text(const std::vector<int64_t>& shape) {
  std::string text;
  for (const int64_t size : shape) {
    text += (text.empty() ? "(" : ",") + (size < 0 ? "V" : std::to_string(size));
  }
  return text + ")";
}

const TensorInfo& require_only_input(const Network& network, const std::string& name,
                                     const std::vector<int64_t>& shape) {
  if (network.inputs().empty()) fail(network, "takes no input");
  for (const TensorInfo& input : network.inputs()) {
    if (input.name != name) {
      fail(network, "takes input \"" + input.name + "\", the contract has \"" + name + "\" alone");
    }
    require_shape(network, "input", input, shape);
  }
  return network.inputs().front();
}

const TensorInfo& require_output(const Network& network, const std::string& name,
                                 const std::vector<int64_t>& shape) {
  const auto& outputs = network.outputs();
  const auto found = std::find_if(outputs.begin(), outputs.end(),
                                  [&](const TensorInfo& output) { return output.name == name; });
  if (found == outputs.end()) {
    fail(network, "has no output " + name + "; export the model with tools/export/");
  }
  require_shape(network, "output", *found, shape);
  return *found;
}

}  // namespace unisim::onnx
