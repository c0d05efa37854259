// SPDX-License-Identifier: MIT
// One job of a model: keyframes in, checked views out. Pairs and windows are one each.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "drivers/image.h"
#include "drivers/onnx/model.hpp"
#include "drivers/onnx/outputs.hpp"
#include "drivers/onnx/preprocessor.hpp"
#include "drivers/onnx/view_store.hpp"

namespace unisim::onnx {

/// The keyframes as one model wants them; shared by the roles of that model.
class Views {
 public:
  /// For images of one size, the newest `capacity` of them.
  Views(const Contract& contract, int32_t image_width, int32_t image_height, int32_t capacity,
        int64_t view_floats)
      : preprocessor_(contract, image_width, image_height), store_(capacity, view_floats) {}

  void add(int32_t id, const unisim_image& image) { preprocessor_.run(image, store_.add(id)); }
  const float* find(int32_t id) const { return store_.find(id); }
  const Framing& framing() const { return preprocessor_.framing(); }
  int64_t bytes() const { return preprocessor_.bytes() + store_.bytes(); }

 private:
  Preprocessor preprocessor_;
  ViewStore store_;
};

/// Answer of a role.
struct Answer {
  std::string problem;      ///< "" when there is a prediction
  bool run_failed = false;  ///< the runtime gave up, not the model
};

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
