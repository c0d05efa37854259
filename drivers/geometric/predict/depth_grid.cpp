// SPDX-License-Identifier: MIT
// Depth of a keyframe on a coarse grid.
#include "drivers/geometric/predict/depth_grid.hpp"

#include <algorithm>
#include <cmath>

namespace unisim::geometric {

namespace {

constexpr double kSigma = 2.0;       // cells
constexpr double kMinWeight = 0.05;  // of the neighbours together
constexpr double kBetween = 0.5;     // confidence of a well supported cell without a landmark
constexpr double kDisagreement = 10.0;
constexpr double kSoftConfidence = 0.5;
constexpr double kSoftSpread = 0.1;

size_t cell_of(int column, int row, const cv::Size& grid) {
  return static_cast<size_t>(row) * static_cast<size_t>(grid.width) + static_cast<size_t>(column);
}

/// The middle of a cell lies where nothing is to be looked at.
bool hidden(const unisim_image& mask, int column, int row, const cv::Size& grid) {
  if (mask.data == nullptr) return false;
  const int x = (2 * column + 1) * mask.width / (2 * grid.width);
  const int y = (2 * row + 1) * mask.height / (2 * grid.height);
  return mask.data[static_cast<size_t>(y) * static_cast<size_t>(mask.stride) +
                   static_cast<size_t>(x)] == 0;
}

}  // namespace

cv::Size depth_grid_size(const cv::Size& image) {
  const int rows = (kGridWidth * image.height + image.width / 2) / std::max(1, image.width);
  return {kGridWidth, std::clamp(rows, 1, 4 * kGridWidth)};
}

void DepthGrid::reserve(const cv::Size& grid) {
  const auto cells = static_cast<size_t>(grid.area());
  weight_.resize(cells);
  sum_.resize(cells);
  square_.resize(cells);
  for (int i = 0; i <= kSpreadReach; ++i) {
    bell_[static_cast<size_t>(i)] = std::exp(-i * i / (2 * kSigma * kSigma));
  }
}

void DepthGrid::spread(int column, int row, double inverse_depth, double weight,
                       const cv::Size& grid) {
  for (int y = std::max(0, row - kSpreadReach); y <= std::min(grid.height - 1, row + kSpreadReach);
       ++y) {
    for (int x = std::max(0, column - kSpreadReach);
         x <= std::min(grid.width - 1, column + kSpreadReach); ++x) {
      const double w = weight * bell_[static_cast<size_t>(std::abs(y - row))] *
                       bell_[static_cast<size_t>(std::abs(x - column))];
      const size_t cell = cell_of(x, y, grid);
      weight_[cell] += w;
      sum_[cell] += w * inverse_depth;
      square_[cell] += w * inverse_depth * inverse_depth;
    }
  }
}

void DepthGrid::run(const State& state, int32_t keyframe, const cv::Size& grid, float* depth,
                    float* confidence) {
  for (auto* field : {&weight_, &sum_, &square_}) std::fill(field->begin(), field->end(), 0.0);
  std::fill(depth, depth + grid.area(), 0.0F);
  std::fill(confidence, confidence + grid.area(), 0.0F);
  const Keyframe& from = state.map.keyframe(keyframe);
  for (int32_t i = 0; i < from.observations; ++i) {
    const Observation& seen = state.map.observation(keyframe, i);
    if (seen.landmark < 0 || seen.outlier) continue;
    const Landmark& mark = state.map.landmark(seen.landmark);
    if (mark.state != LandmarkState::kPlaced) continue;
    const double z = from.pose.apply(mark.position).z();
    if (!(z > kMinDepth)) continue;
    const int column =
        std::clamp(static_cast<int>((seen.x + 0.5F) * static_cast<float>(grid.width) /
                                    static_cast<float>(state.size.width)),
                   0, grid.width - 1);
    const int row = std::clamp(static_cast<int>((seen.y + 0.5F) * static_cast<float>(grid.height) /
                                                static_cast<float>(state.size.height)),
                               0, grid.height - 1);
    spread(column, row, 1 / z, mark.soft ? kSoftSpread : 1.0, grid);
    const size_t cell = cell_of(column, row, grid);
    const auto sure = static_cast<float>(mark.soft ? kSoftConfidence : 1.0);
    if (sure <= confidence[cell]) continue;
    confidence[cell] = sure;
    depth[cell] = static_cast<float>(z);
  }
  for (size_t cell = 0; cell < weight_.size(); ++cell) {
    if (confidence[cell] > 0 || weight_[cell] < kMinWeight) continue;
    const int at = static_cast<int>(cell);
    if (hidden(state.config.mask, at % grid.width, at / grid.width, grid)) continue;
    const double mean = sum_[cell] / weight_[cell];
    const double variance = std::max(0.0, square_[cell] / weight_[cell] - mean * mean);
    depth[cell] = static_cast<float>(1 / mean);
    confidence[cell] = static_cast<float>(kBetween * std::min(1.0, weight_[cell]) /
                                          (1 + kDisagreement * std::sqrt(variance) / mean));
  }
}

}  // namespace unisim::geometric
