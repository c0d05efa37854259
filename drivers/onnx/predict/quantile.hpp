// SPDX-License-Identifier: MIT
// Confidence by quantile: models give numbers of many kinds, of which only the order means
// something.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace unisim::onnx {

/// Ranks values in memory of its own, taken once.
class QuantileRanker {
 public:
  explicit QuantileRanker(size_t capacity) : keys_(capacity) {}

  /// Replace each value by its rank over count - 1: 0 the least, 1 the largest, equal ones the mean
  /// of theirs. O(n log n).
  /// @param values finite, count <= capacity
  void rank(float* values, size_t count);

 private:
  std::vector<uint64_t> keys_;  // order of the value, then its place
};

}  // namespace unisim::onnx
