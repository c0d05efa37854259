// SPDX-License-Identifier: MIT
// Keyframes saved and loaded, with their nodes.
#include "core/map/keyframe_ring.hpp"
#include "core/session_config.hpp"

namespace unisim {
namespace {

void visit_keyframe(Archive* archive, int32_t id, Graph* graph, Keyframe* keyframe) {
  archive->value(&keyframe->timestamp_ns);
  bool has_node = keyframe->node >= 0;
  archive->flag(&has_node);
  if (has_node) graph->visit_node(archive, NodeKind::kKeyframe, &keyframe->node);
  archive->index(&keyframe->owner, -1, kMostId);
  archive->expect(!has_node || !keyframe->retired());
  if (keyframe->retired()) archive->pose(&keyframe->T_owner_kf);
  archive->index(&keyframe->held_from, -1, id - 1);
  archive->index(&keyframe->segment, -1, kLastId);
  archive->expect(!keyframe->posed() || keyframe->segment >= 0);
  archive->choice(&keyframe->state, Tracking::kRelocalised);
  archive->index(&keyframe->best_submap, -1, kMostId);
  archive->index(&keyframe->best_distance, 0, kMaxViews);
  archive->index(&keyframe->window_count, 0, kLastId);
  archive->index(&keyframe->loop_count, 0, kLastId);
}

}  // namespace

void KeyframeRing::visit(Archive* archive, Graph* graph) {
  archive->index(&size_, 0, kLastId + 1);
  archive->index(&first_, 0, size_);
  archive->index(&settled_, first_, std::max(first_, size_ - 1));
  archive->need("max_keyframes", size_ - first_, capacity());
  for (int32_t id = first_; archive->ok() && id < size_; ++id) {
    if (archive->loading()) (*this)[id] = Keyframe();
    visit_keyframe(archive, id, graph, &(*this)[id]);
  }
}

}  // namespace unisim
