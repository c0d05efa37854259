// SPDX-License-Identifier: MIT
// Edges between submaps that see the same keyframes: tie and scale.
#pragma once

#include <cstdint>

#include "core/base/span.hpp"
#include "core/map/map.hpp"

namespace unisim {

/// Makes, changes and drops them with the submaps they belong to; a bounded number of pairs of
/// submaps is tied at a time.
class TieEdges {
 public:
  /// @param capacity pairs of submaps
  TieEdges(Map& map, int32_t capacity) : map_(map), capacity_(capacity) {}

  /// Tie a submap to those its views share a keyframe with. A pair beyond the capacity goes
  /// without.
  void add(int32_t submap);
  /// Depth in the submap has changed by these log ratios, one per view, and its quality perhaps.
  void rescale(int32_t submap, Span<const double> log_depth_ratio);
  /// Forget all the submap shares.
  void drop(int32_t submap);

  int32_t pairs() const { return pairs_; }

  /// Save or load; submaps and nodes are there.
  void visit(Archive* archive);

 private:
  bool take_pair(int32_t m, int32_t n);
  void add_scale(int32_t m, int32_t n);
  void count_pairs();
  Sim3 measurement(const SharedKeyframe& shared) const;
  double multiplier(int32_t m, int32_t n) const;
  double median_log_c(int32_t m, int32_t n) const;

  Map& map_;
  int32_t capacity_;
  int32_t pairs_ = 0;
};

}  // namespace unisim
