// SPDX-License-Identifier: MIT
// A few points of a window, for people and planners.
#include "drivers/pipeline/submap_points.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/pipeline/similarity.hpp"

namespace unisim::pipeline {
namespace {

// As the session leaves them out of depth ratios, and map.ply does.
constexpr double kLeastSure = 0.25;

struct Sample {
  float x;  // of the image plane at depth 1
  float y;
  float depth;
  float confidence;
};

/// Every step-th pixel of a view that has a depth.
void take_samples(const unisim_depth_map& map, int step, float width, float height,
                  std::vector<Sample>* samples) {
  samples->clear();
  for (int row = step / 2; row < map.height; row += step) {
    for (int column = step / 2; column < map.width; column += step) {
      const auto pixel =
          static_cast<size_t>(row) * static_cast<size_t>(map.width) + static_cast<size_t>(column);
      const float depth = map.depth[pixel];
      const float confidence = map.confidence != nullptr ? map.confidence[pixel] : 1.0F;
      if (!std::isfinite(depth) || depth <= 0.0F || !std::isfinite(confidence)) continue;
      const float x = (static_cast<float>(column) + 0.5F) / static_cast<float>(map.width) - 0.5F;
      const float y = (static_cast<float>(row) + 0.5F) / static_cast<float>(map.height) - 0.5F;
      samples->push_back({x * width, y * height, depth, confidence});
    }
  }
}

void drop_least_sure(std::vector<Sample>* samples) {
  const auto drop = static_cast<ptrdiff_t>(kLeastSure * static_cast<double>(samples->size()));
  const auto less = [](const Sample& a, const Sample& b) { return a.confidence < b.confidence; };
  std::nth_element(samples->begin(), samples->begin() + drop, samples->end(), less);
  samples->erase(samples->begin(), samples->begin() + drop);
}

}  // namespace

void sample_points(const unisim_window_prediction& window, int32_t image_width,
                   int32_t image_height, int32_t most, std::vector<float>* xyz) {
  xyz->clear();
  if (!(window.focal_px > 0.0) || window.count <= 0) return;
  const auto width = static_cast<float>(image_width / window.focal_px);
  const auto height = static_cast<float>(image_height / window.focal_px);
  const unisim_sim3 T_anchor_window = inverse(window.T_window_kf[window.count / 2]);
  std::vector<Sample> samples;
  for (int32_t view = 0; view < window.count; ++view) {
    const unisim_depth_map& map = window.depth[view];
    if (map.width <= 0 || map.height <= 0) continue;
    const double share = std::max(1.0, static_cast<double>(most) / window.count / (1 - kLeastSure));
    const double pixels = static_cast<double>(map.width) * map.height;
    const int step = std::max(1, static_cast<int>(std::ceil(std::sqrt(pixels / share))));
    take_samples(map, step, width, height, &samples);
    drop_least_sure(&samples);
    const unisim_sim3 T = compose(T_anchor_window, window.T_window_kf[view]);
    for (const Sample& sample : samples) {
      const double depth = sample.depth;
      const unisim_sim3 point = {
          {0.0, 0.0, 0.0, 1.0}, {sample.x * depth, sample.y * depth, depth}, 1.0};
      for (const double value : compose(T, point).t) {
        xyz->push_back(static_cast<float>(value));
      }
    }
  }
  xyz->resize(std::min(xyz->size(), 3 * static_cast<size_t>(most)));
}

}  // namespace unisim::pipeline
