// SPDX-License-Identifier: MIT
// Weights that resample one axis.
#include "drivers/onnx/image/axis_resampler.hpp"

#include <algorithm>
#include <cmath>

namespace unisim::onnx {

AxisResampler::AxisResampler(int32_t from, int32_t to) {
  const double step = static_cast<double>(from) / to;
  const double radius = std::max(step, 1.0);
  for (int32_t index = 0; index < to; ++index) {
    const double center = (index + 0.5) * step;
    const int32_t first = std::max(static_cast<int32_t>(std::floor(center - radius)), 0);
    const int32_t end = std::min(static_cast<int32_t>(std::ceil(center + radius)), from);
    std::vector<double> tent;
    double sum = 0;
    for (int32_t source = first; source < end; ++source) {
      tent.push_back(std::max(0.0, 1 - std::abs(source + 0.5 - center) / radius));
      sum += tent.back();
    }
    spans_.push_back({first, end - first, weights_.size()});
    for (const double weight : tent) weights_.push_back(static_cast<float>(weight / sum));
  }
}

}  // namespace unisim::onnx
