// SPDX-License-Identifier: MIT
// Lines about loaded models that are worth telling once.
#pragma once

#include <string>
#include <vector>

#include "drivers/onnx/model/encoder.hpp"
#include "drivers/onnx/model/model.hpp"
#include "drivers/onnx/predict/views.hpp"

namespace unisim::onnx {

/// "MODEL, WIDTHxHEIGHT, licence: LICENCE"
std::string licence_line(const Contract& contract);

/// Time and memory of the inferences that were run or are stated.
/// @param what "" or a word that follows the model's name
std::string cost_line(const Contract& contract, const std::string& what,
                      const std::vector<Cost>& costs);

/// Memory of the keyframes that are kept.
std::string ring_line(const Views& views);

/// Why windows are smaller than asked for, "" when they are not.
std::string reduction_line(const Model& model, int32_t wanted, int64_t memory_bytes);

}  // namespace unisim::onnx
