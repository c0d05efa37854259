// SPDX-License-Identifier: MIT
// Texture pyramid.
#include "tools/synth/texture.hpp"

namespace unisim::synth {
namespace {

constexpr int kMostProbes = 8;

uint8_t to_byte(float value) {
  return static_cast<uint8_t>(std::clamp(value, 0.0f, 255.0f) + 0.5f);
}

float length(float x, float y) { return std::sqrt(x * x + y * y); }

/// Four floats are one vector register.
Eigen::Vector4f to_float(const std::array<uint8_t, 4>& texel) {
  return Eigen::Map<const Eigen::Matrix<uint8_t, 4, 1>>(texel.data()).cast<float>();
}

}  // namespace

Texture::Texture(const Canvas& canvas) {
  Level base{canvas.columns(), canvas.rows(), {}};
  base.texels.reserve(static_cast<size_t>(base.columns) * static_cast<size_t>(base.rows));
  for (int row = 0; row < base.rows; ++row) {
    for (int column = 0; column < base.columns; ++column) {
      const Color& color = canvas.at(column, row);
      base.texels.push_back({to_byte(color[0]), to_byte(color[1]), to_byte(color[2]), 0});
    }
  }
  levels_.push_back(std::move(base));
  while (levels_.back().columns > 1 || levels_.back().rows > 1) {
    levels_.push_back(halve(levels_.back()));
  }
}

Texture::Level Texture::halve(const Level& level) {
  Level half{std::max(1, level.columns / 2), std::max(1, level.rows / 2), {}};
  half.texels.reserve(static_cast<size_t>(half.columns) * static_cast<size_t>(half.rows));
  for (int row = 0; row < half.rows; ++row) {
    for (int column = 0; column < half.columns; ++column) {
      // Taken at fractions of the size, so that a level of odd size is not shifted by its halving.
      const float s0 = (static_cast<float>(column) + 0.25f) / static_cast<float>(half.columns);
      const float s1 = (static_cast<float>(column) + 0.75f) / static_cast<float>(half.columns);
      const float t0 = (static_cast<float>(row) + 0.25f) / static_cast<float>(half.rows);
      const float t1 = (static_cast<float>(row) + 0.75f) / static_cast<float>(half.rows);
      const Eigen::Vector4f mean = 0.25f * (bilinear(level, s0, t0) + bilinear(level, s1, t0) +
                                            bilinear(level, s0, t1) + bilinear(level, s1, t1));
      half.texels.push_back({to_byte(mean[0]), to_byte(mean[1]), to_byte(mean[2]), 0});
    }
  }
  return half;
}

Eigen::Vector4f Texture::bilinear(const Level& level, float s, float t) {
  const float x = std::clamp(s * static_cast<float>(level.columns) - 0.5f, 0.0f,
                             static_cast<float>(level.columns - 1));
  const float y = std::clamp(t * static_cast<float>(level.rows) - 0.5f, 0.0f,
                             static_cast<float>(level.rows - 1));
  const int column = static_cast<int>(x);
  const int row = static_cast<int>(y);
  const float a = x - static_cast<float>(column);
  const float b = y - static_cast<float>(row);
  const int right = column + 1 < level.columns ? 1 : 0;
  const int below = row + 1 < level.rows ? level.columns : 0;
  const auto* texel = level.texels.data() + static_cast<ptrdiff_t>(row) * level.columns + column;
  return (1.0f - b) * ((1.0f - a) * to_float(texel[0]) + a * to_float(texel[right])) +
         b * ((1.0f - a) * to_float(texel[below]) + a * to_float(texel[below + right]));
}

Eigen::Vector4f Texture::trilinear(float level, float s, float t) const {
  const float last = static_cast<float>(levels_.size() - 1);
  const float clamped = std::clamp(level, 0.0f, last);
  const auto finer = static_cast<size_t>(clamped);
  const float weight = clamped - static_cast<float>(finer);
  const Eigen::Vector4f fine = bilinear(levels_[finer], s, t);
  if (weight <= 0.0f) {
    return fine;
  }
  return (1.0f - weight) * fine + weight * bilinear(levels_[finer + 1], s, t);
}

Color Texture::sample(const Footprint& footprint) const {
  const float columns = static_cast<float>(levels_[0].columns);
  const float rows = static_cast<float>(levels_[0].rows);
  const float across = length(footprint.ds_du * columns, footprint.dt_du * rows);
  const float down = length(footprint.ds_dv * columns, footprint.dt_dv * rows);
  const float longer = std::max(across, down);
  const float shorter = std::max(std::min(across, down), 1e-6f);
  // Probes as far apart as the footprint is wide; below one texel nothing is gained by more.
  const float wanted = longer / std::max(shorter, 1.0f);
  const int probes = std::clamp(static_cast<int>(std::ceil(wanted - 0.1f)), 1, kMostProbes);
  const float level = std::log2(std::max(longer / static_cast<float>(probes), shorter));
  const float ds = across > down ? footprint.ds_du : footprint.ds_dv;
  const float dt = across > down ? footprint.dt_du : footprint.dt_dv;
  Eigen::Vector4f sum = Eigen::Vector4f::Zero();
  for (int probe = 0; probe < probes; ++probe) {
    const float offset = (static_cast<float>(probe) + 0.5f) / static_cast<float>(probes) - 0.5f;
    sum += trilinear(level, footprint.s + offset * ds, footprint.t + offset * dt);
  }
  return sum.head<3>() / static_cast<float>(probes);
}

}  // namespace unisim::synth
