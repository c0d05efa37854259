// SPDX-License-Identifier: MIT
// Depth of a keyframe on a coarse grid: measured where there is a landmark, interpolated in
// between.
#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <vector>

#include "drivers/geometric/map/state.hpp"

namespace unisim::geometric {

inline constexpr int kGridWidth = 80;
inline constexpr int kSpreadReach = 5;  ///< cells that a landmark's depth reaches

/// Grid of kGridWidth columns whose cells cover the image and are nearly square.
cv::Size depth_grid_size(const cv::Size& image);

class DepthGrid {
 public:
  void reserve(const cv::Size& grid);
  /// Writes grid.area() z-depths (0: none) and confidences (0..1). A landmark's own cell has the
  /// highest confidence (half of it for guessed depths); cells between landmarks get less, the more
  /// their depths disagree; cells far from any stay empty.
  void run(const State& state, int32_t keyframe, const cv::Size& grid, float* depth,
           float* confidence);

 private:
  void spread(int column, int row, double inverse_depth, double weight, const cv::Size& grid);

  std::array<double, kSpreadReach + 1> bell_{};  // weight by distance in cells
  std::vector<double> weight_;
  std::vector<double> sum_;
  std::vector<double> square_;
};

}  // namespace unisim::geometric
