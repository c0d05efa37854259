// SPDX-License-Identifier: MIT
// One job of a model: keyframes in, checked views out. Pairs and windows are one each.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "drivers/onnx/model/model.hpp"
#include "drivers/onnx/predict/answer.hpp"
#include "drivers/onnx/predict/outputs.hpp"
#include "drivers/onnx/predict/views.hpp"

namespace unisim::onnx {

class Role {
 public:
  Role(std::shared_ptr<Model> model, std::shared_ptr<Views> views, int32_t max_views,
       double min_pose_confidence)
      : model_(std::move(model)),
        views_(std::move(views)),
        min_pose_confidence_(min_pose_confidence),
        outputs_(max_views, views_->framing()) {}

  Answer predict(const int32_t* ids, int32_t count);
  const Outputs& outputs() const { return outputs_; }

 private:
  std::shared_ptr<Model> model_;
  std::shared_ptr<Views> views_;
  double min_pose_confidence_;
  Outputs outputs_;
};

}  // namespace unisim::onnx
