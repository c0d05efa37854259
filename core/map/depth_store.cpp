// SPDX-License-Identifier: MIT
// Sampled depth of the keyframes that coming windows may still need.
#include "core/map/depth_store.hpp"

namespace unisim {

DepthStore::DepthStore(Arena& arena, int32_t slots, int32_t cells)
    : sources_(arena.take<Source>(slots)),
      depth_(arena.take<float>(slots * cells)),
      cells_(cells) {}

int32_t DepthStore::slot_of(int32_t keyframe) const {
  for (int32_t slot = 0; slot < sources_.size(); ++slot) {
    if (sources_[slot].keyframe == keyframe) return slot;
  }
  return -1;
}

Span<float> DepthStore::put(const Source& source) {
  if (sources_.empty()) return {};
  int32_t slot = slot_of(source.keyframe);
  if (slot < 0) {
    slot = next_;
    next_ = (next_ + 1) % sources_.size();
  }
  sources_[slot] = source;
  return depth_.subspan(slot * cells_, cells_);
}

Span<const float> DepthStore::find(int32_t keyframe) const {
  const int32_t slot = slot_of(keyframe);
  if (slot < 0) return {};
  return depth_.subspan(slot * cells_, cells_);
}

DepthStore::Source DepthStore::source_of(int32_t keyframe) const {
  const int32_t slot = slot_of(keyframe);
  return slot < 0 ? Source{} : sources_[slot];
}

void DepthStore::rescale(int32_t submap, int32_t view, double factor) {
  for (int32_t slot = 0; slot < sources_.size(); ++slot) {
    if (sources_[slot].submap != submap || sources_[slot].view != view) continue;
    for (float& depth : depth_.subspan(slot * cells_, cells_)) {
      depth = static_cast<float>(depth * factor);
    }
  }
}

}  // namespace unisim
