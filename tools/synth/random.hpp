// SPDX-License-Identifier: MIT
// Random numbers that are the same on every machine: SplitMix64 and its finalizer as a hash.
#pragma once

#include <cstdint>

namespace unisim::synth {

/// Well-mixed 64 bits of one number.
inline uint64_t hash(uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// Independent seed for part `index` of something seeded with `seed`.
inline uint64_t derive_seed(uint64_t seed, uint64_t index) { return hash(hash(seed) + index); }

class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed) {}

  uint64_t next() {
    const uint64_t value = hash(state_);
    state_ += 0x9e3779b97f4a7c15u;
    return value;
  }

  /// In [0, 1).
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// In 0 .. count - 1.
  int below(int count) { return static_cast<int>(uniform() * count); }

 private:
  uint64_t state_;
};

}  // namespace unisim::synth
