// SPDX-License-Identifier: MIT
// Inputs and outputs of a network against the shapes of the model contract.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/onnx/runtime/network.hpp"

namespace unisim::onnx {

/// A size that the contract leaves open.
inline constexpr int64_t kAnySize = -1;

/// "(1,V,3,12,16)"
std::string shape_text(const std::vector<int64_t>& shape);

/// @throws OnnxError (UNISIM_ONNX_BAD_MODEL) when the network takes anything else
const TensorInfo& require_only_input(const Network& network, const std::string& name,
                                     const std::vector<int64_t>& shape);

/// @throws OnnxError (UNISIM_ONNX_BAD_MODEL) when the network does not give it in that shape
const TensorInfo& require_output(const Network& network, const std::string& name,
                                 const std::vector<int64_t>& shape);

}  // namespace unisim::onnx
