// SPDX-License-Identifier: MIT
// Sampled depth of the keyframes that coming windows may still need.
#include "core/map/depth_store.hpp"

#include <algorithm>

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

void DepthStore::visit(Archive* archive) {
  const int32_t slots = sources_.size();
  int32_t count = 0;
  for (const Source& source : sources_) count += source.keyframe >= 0 ? 1 : 0;
  const int32_t oldest = count == slots ? next_ : 0;
  archive->index(&count, 0, kMostId);
  const int32_t left_out = std::max<int32_t>(0, count - slots);
  for (int32_t k = 0; archive->ok() && k < count; ++k) {
    const int32_t slot = archive->loading() ? k - left_out : (oldest + k) % slots;
    visit_map(archive, slot);
  }
  if (archive->loading() && slots > 0) next_ = (count - left_out) % slots;
}

/// @param slot < 0: the map is read and forgotten
void DepthStore::visit_map(Archive* archive, int32_t slot) {
  const bool kept = slot >= 0;
  Source source;
  if (!archive->loading()) source = sources_[slot];
  archive->index(&source.keyframe, 0, kMostId);
  archive->index(&source.submap, -1, kMostId);
  archive->index(&source.view, -1, kMostId);
  if (archive->loading() && kept) sources_[slot] = source;
  for (int32_t cell = 0; archive->ok() && cell < cells_; ++cell) {
    float none = 0.0F;
    float* depth = kept ? &depth_[slot * cells_ + cell] : &none;
    archive->value(depth);
    archive->expect(*depth >= 0.0F);
  }
}

}  // namespace unisim
