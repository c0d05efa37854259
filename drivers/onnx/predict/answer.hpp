// SPDX-License-Identifier: MIT
// How it went with a model: fine, refused, or not run at all.
#pragma once

#include <string>

namespace unisim::onnx {

struct Answer {
  std::string problem;      ///< "" when all is well
  bool run_failed = false;  ///< the runtime gave up, not the model
};

}  // namespace unisim::onnx
