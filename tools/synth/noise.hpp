// SPDX-License-Identifier: MIT
// Value noise and its sum of octaves, whose spectrum falls as that of natural surfaces.
#pragma once

#include <cstdint>

namespace unisim::synth {

/// Smooth noise in [-1, 1] with one random value per unit square.
float value_noise(float x, float y, uint64_t seed);

/// Octaves of value_noise: spacing halves and amplitude is multiplied by `gain` from each to the
/// next. In about [-1, 1].
float fractal_noise(float x, float y, uint64_t seed, int octaves, float gain);

}  // namespace unisim::synth
