// SPDX-License-Identifier: MIT
// The model or models of a predictor: loaded, suited to their roles, warm.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "drivers/onnx/config.hpp"
#include "drivers/onnx/model.hpp"

namespace unisim::onnx {

struct Models {
  std::shared_ptr<Model> pair;
  std::shared_ptr<Model> window;   ///< may be the same
  int32_t window_size = 0;         ///< views that model and memory allow
  std::vector<std::string> notes;  ///< lines worth telling
};

/// @throws OnnxError
Models load_models(const Config& config);

}  // namespace unisim::onnx
