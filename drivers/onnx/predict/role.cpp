// SPDX-License-Identifier: MIT
// One job of a model.
#include "drivers/onnx/predict/role.hpp"

#include <algorithm>

namespace unisim::onnx {

Answer Role::predict(const int32_t* ids, int32_t count) {
  for (int32_t view = 0; view < count; ++view) {
    std::string problem = views_->copy(ids[view], model_->input(view));
    if (!problem.empty()) return {std::move(problem), false};
  }
  const std::string failure = model_->run(count);
  if (!failure.empty()) return {model_->path() + ": " + failure, true};
  if (model_->pose_confidence() < min_pose_confidence_) {
    return {"pose confidence " + std::to_string(model_->pose_confidence()) + " is below " +
                std::to_string(min_pose_confidence_),
            false};
  }
  return {outputs_.read(*model_, count), false};
}

}  // namespace unisim::onnx
