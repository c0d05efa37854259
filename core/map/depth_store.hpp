// SPDX-License-Identifier: MIT
// Sampled depth of the keyframes that coming windows may still need.
#pragma once

#include <cstdint>

#include "core/base/arena.hpp"
#include "core/base/span.hpp"
#include "core/snapshot/archive.hpp"

namespace unisim {

/// A fixed number of sampled depth maps, at most one per keyframe; the oldest gives way.
class DepthStore {
 public:
  /// Where a stored map comes from.
  struct Source {
    int32_t keyframe = -1;
    int32_t submap = -1;  ///< submap whose prediction it is; -1: a two-view prediction
    int32_t view = -1;    ///< position in that submap
  };

  DepthStore() = default;
  DepthStore(Arena& arena, int32_t slots, int32_t cells);

  /// Memory to write the keyframe's depth into; takes the place of its older map or of the oldest
  /// map of all. Empty when the store has no slots.
  Span<float> put(const Source& source);

  /// Depth of the keyframe; empty when it is not stored (any more). O(slots).
  Span<const float> find(int32_t keyframe) const;
  /// Where the keyframe's stored depth comes from; keyframe -1 when it is not stored.
  Source source_of(int32_t keyframe) const;

  /// Multiply what is stored of a submap's view by `factor`.
  void rescale(int32_t submap, int32_t view, double factor);

  /// Save or load, the oldest first; what there is no room for is left out.
  void visit(Archive* archive);
  /// Where each map comes from; keyframe -1: none is there.
  Span<const Source> sources() const { return sources_; }

 private:
  int32_t slot_of(int32_t keyframe) const;
  void visit_map(Archive* archive, int32_t slot);

  Span<Source> sources_;
  Span<float> depth_;
  int32_t cells_ = 0;
  int32_t next_ = 0;
};

}  // namespace unisim
