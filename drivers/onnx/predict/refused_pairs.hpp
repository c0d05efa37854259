// SPDX-License-Identifier: MIT
// Which views of a refused window are to blame, as the pairs inside it tell.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

namespace unisim::onnx {

/// One image can upset a network so that no view of its window is of use. Its pairs are refused for
/// the same reason, which cuts the map in two there; only a window over the cut joins it again.
/// One thread settles while another asks.
class RefusedPairs {
 public:
  /// @param capacity newest keyframes whose pairs are remembered
  explicit RefusedPairs(int32_t capacity) : refused_(static_cast<size_t>(capacity)) {}

  /// What became of pair (j - 1, j). Pairs come in order.
  void settle(int32_t j, bool refused);

  /// Keyframes to blame, most likely first. Of a refused pair alone nobody knows which of the two
  /// it is: a network may stumble over the first view only, and the newest keyframe has one pair.
  enum class Blame {
    kBothPairs,  ///< the pair before and the pair after it were refused
    kFirst,      ///< the pair after it was
    kSecond      ///< the pair before it was
  };
  static constexpr Blame kBlames[] = {Blame::kBothPairs, Blame::kFirst, Blame::kSecond};

  /// @param newest keyframe of the window: what later pairs say does not count, so that the answer
  ///               is the same whenever it is asked for
  bool blamed(int32_t keyframe, Blame blame, int32_t newest) const;

 private:
  bool pair_refused(int32_t j) const;

  mutable std::mutex mutex_;
  int32_t newest_ = 0;                  // settled
  std::vector<unsigned char> refused_;  // by j, a ring
};

}  // namespace unisim::onnx
