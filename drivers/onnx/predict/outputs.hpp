// SPDX-License-Identifier: MIT
// From a model's outputs to a prediction: what is not right is refused and named.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/onnx/image/framing.hpp"
#include "drivers/onnx/model/model.hpp"
#include "drivers/onnx/predict/quantile.hpp"
#include "unisim/unisim.h"

namespace unisim::onnx {

/// The views of one inference, checked. Holds its own memory, taken once.
class Outputs {
 public:
  Outputs(int32_t views, const Framing& framing);

  /// Read the last run of `model`: poses re-anchored to view 0, nearest rotations, depth and
  /// confidence on the grid of the whole image, confidence by quantile.
  /// @return "" or what is wrong with the prediction
  std::string read(const Model& model, int32_t views);

  const std::vector<unisim_sim3>& T_0_view() const { return T_0_view_; }
  const std::vector<unisim_depth_map>& maps() const { return maps_; }
  double focal_px() const { return focal_px_; }  ///< of the image; geometric mean of all views
  int64_t bytes() const;

 private:
  std::string read_poses(const Model& model, int32_t views);
  std::string read_focal(const Model& model, int32_t views);
  std::string read_maps(const Model& model, int32_t view);

  Framing framing_;
  size_t pixels_;
  std::vector<float> depth_;
  std::vector<float> confidence_;
  std::vector<unisim_sim3> T_0_view_;
  std::vector<unisim_depth_map> maps_;
  QuantileRanker ranker_;
  double focal_px_ = 0;
};

}  // namespace unisim::onnx
