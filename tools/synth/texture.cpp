// SPDX-License-Identifier: MIT
// Texture pyramid.
#include "tools/synth/texture.hpp"

#include <opencv2/core/hal/intrin.hpp>

namespace unisim::synth {
namespace {

constexpr int kMostProbes = 8;

/// Red, green, blue and padding in one vector register.
using Lanes = cv::v_float32x4;

Lanes repeat(float value) { return cv::v_setall_f32(value); }

Lanes load(const std::array<uint8_t, 4>& texel) {
  return cv::v_cvt_f32(cv::v_reinterpret_as_s32(cv::v_load_expand_q(texel.data())));
}

Lanes mix(const Lanes& first, const Lanes& second, float share) {
  return first + (second - first) * repeat(share);
}

Color to_color(const Lanes& lanes) {
  std::array<float, 4> values{};
  cv::v_store(values.data(), lanes);
  return {values[0], values[1], values[2]};
}

uint8_t to_byte(float value) {
  return static_cast<uint8_t>(std::clamp(value, 0.0f, 255.0f) + 0.5f);
}

std::array<uint8_t, 4> to_texel(const Color& color) {
  return {to_byte(color[0]), to_byte(color[1]), to_byte(color[2]), 0};
}

float length(float x, float y) { return std::sqrt(x * x + y * y); }

Lanes bilinear(const TextureLevel& level, float s, float t) {
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
  return mix(mix(load(texel[0]), load(texel[right]), a),
             mix(load(texel[below]), load(texel[below + right]), a), b);
}

Lanes trilinear(const std::vector<TextureLevel>& levels, float level, float s, float t) {
  const float clamped = std::clamp(level, 0.0f, static_cast<float>(levels.size() - 1));
  const auto finer = static_cast<size_t>(clamped);
  const float share = clamped - static_cast<float>(finer);
  const Lanes fine = bilinear(levels[finer], s, t);
  return share > 0 ? mix(fine, bilinear(levels[finer + 1], s, t), share) : fine;
}

TextureLevel halve(const TextureLevel& level) {
  TextureLevel half{std::max(1, level.columns / 2), std::max(1, level.rows / 2), {}};
  half.texels.reserve(static_cast<size_t>(half.columns) * static_cast<size_t>(half.rows));
  for (int row = 0; row < half.rows; ++row) {
    for (int column = 0; column < half.columns; ++column) {
      // Taken at fractions of the size, so that a level of odd size is not shifted by its halving.
      const float s0 = (static_cast<float>(column) + 0.25f) / static_cast<float>(half.columns);
      const float s1 = (static_cast<float>(column) + 0.75f) / static_cast<float>(half.columns);
      const float t0 = (static_cast<float>(row) + 0.25f) / static_cast<float>(half.rows);
      const float t1 = (static_cast<float>(row) + 0.75f) / static_cast<float>(half.rows);
      const Lanes sum = bilinear(level, s0, t0) + bilinear(level, s1, t0) +
                        bilinear(level, s0, t1) + bilinear(level, s1, t1);
      half.texels.push_back(to_texel(0.25f * to_color(sum)));
    }
  }
  return half;
}

}  // namespace

Texture::Texture(const Canvas& canvas) {
  TextureLevel base{canvas.columns(), canvas.rows(), {}};
  base.texels.reserve(static_cast<size_t>(base.columns) * static_cast<size_t>(base.rows));
  for (int row = 0; row < base.rows; ++row) {
    for (int column = 0; column < base.columns; ++column) {
      base.texels.push_back(to_texel(canvas.at(column, row)));
    }
  }
  levels_.push_back(std::move(base));
  while (levels_.back().columns > 1 || levels_.back().rows > 1) {
    levels_.push_back(halve(levels_.back()));
  }
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
  const int probes = std::clamp(static_cast<int>(wanted + 0.5f), 1, kMostProbes);
  const float spacing = 1.0f / static_cast<float>(probes);
  const float level = std::log2(std::max(longer * spacing, shorter));
  const float ds = across > down ? footprint.ds_du : footprint.ds_dv;
  const float dt = across > down ? footprint.dt_du : footprint.dt_dv;
  Lanes sum = repeat(0.0f);
  for (int probe = 0; probe < probes; ++probe) {
    const float offset = (static_cast<float>(probe) + 0.5f) * spacing - 0.5f;
    sum += trilinear(levels_, level, footprint.s + offset * ds, footprint.t + offset * dt);
  }
  return spacing * to_color(sum);
}

}  // namespace unisim::synth
