// SPDX-License-Identifier: MIT
// Value noise.
#include "tools/synth/noise.hpp"

#include <cmath>

namespace unisim::synth {
namespace {

float lattice(int32_t x, int32_t y, uint32_t seed) {
  uint32_t h = seed ^ (static_cast<uint32_t>(x) * 0x85ebca6bu);
  h = (h ^ (h >> 15)) * 0x2c1b3c6du + static_cast<uint32_t>(y) * 0xc2b2ae35u;
  h = (h ^ (h >> 13)) * 0x297a2d39u;
  h ^= h >> 16;
  return static_cast<float>(h & 0xffffffu) * (2.0f / 16777215.0f) - 1.0f;
}

float smooth(float t) { return t * t * (3.0f - 2.0f * t); }

}  // namespace

float value_noise(float x, float y, uint64_t seed) {
  const float floor_x = std::floor(x);
  const float floor_y = std::floor(y);
  const auto i = static_cast<int32_t>(floor_x);
  const auto j = static_cast<int32_t>(floor_y);
  const auto s = static_cast<uint32_t>(seed ^ (seed >> 32));
  const float a = smooth(x - floor_x);
  const float b = smooth(y - floor_y);
  const float top = lattice(i, j, s) * (1.0f - a) + lattice(i + 1, j, s) * a;
  const float bottom = lattice(i, j + 1, s) * (1.0f - a) + lattice(i + 1, j + 1, s) * a;
  return top * (1.0f - b) + bottom * b;
}

float fractal_noise(float x, float y, uint64_t seed, int octaves, float gain) {
  float sum = 0.0f;
  float amplitude = 1.0f;
  float total = 0.0f;
  for (int octave = 0; octave < octaves; ++octave) {
    // The offset keeps the lattices of the octaves from meeting at the origin.
    const float offset = 17.31f * static_cast<float>(octave);
    sum += amplitude * value_noise(x + offset, y + offset, seed + static_cast<uint64_t>(octave));
    total += amplitude;
    amplitude *= gain;
    x *= 2.0f;
    y *= 2.0f;
  }
  return sum / total * 1.6f;
}

}  // namespace unisim::synth
