// SPDX-License-Identifier: MIT
// The model or models of a predictor: loaded, suited to their roles, warm.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "drivers/onnx/config.hpp"
#include "drivers/onnx/model/encoder.hpp"
#include "drivers/onnx/model/model.hpp"
#include "drivers/onnx/predict/views.hpp"

namespace unisim::onnx {

struct Models {
  std::shared_ptr<Model> pair;
  std::shared_ptr<Model> window;                   ///< its network may be the same
  std::vector<std::shared_ptr<Encoder>> encoders;  ///< of split models
  std::shared_ptr<Views> pair_views;
  std::shared_ptr<Views> window_views;  ///< the same for one model or one encoder
  int32_t window_size = 0;              ///< views that model and memory allow
  std::vector<std::string> notes;       ///< lines worth telling

  int64_t bytes() const;
};

/// @throws OnnxError
Models load_models(const Config& config);

}  // namespace unisim::onnx
