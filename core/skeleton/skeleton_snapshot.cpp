// SPDX-License-Identifier: MIT
// The past of a map saved and loaded, and the edges of the map.
#include "core/skeleton/skeleton.hpp"

namespace unisim {
namespace {

void visit_counts(Archive* archive, SkeletonCounts* counts) {
  archive->index(&counts->keyframes, 0, kMostCount);
  archive->index(&counts->windows, 0, kMostCount);
  archive->index(&counts->loops, 0, kMostCount);
  archive->index(&counts->stretches, 0, kMostCount);
  archive->index(&counts->loops_removed, 0, kMostCount);
}

}  // namespace

void Skeleton::visit(Archive* archive) {
  archive->index(&live_from_, 0, map_.keyframes.size());
  visit_counts(archive, &counts_);
  watch_.visit(archive);
  if (archive->loading()) find_live_submaps(archive);
  visit_nodes(archive);
  loop_edges_.visit(archive);
  outbox_.visit(archive, map_.keyframes, map_.submaps.next_id());
  if (archive->loading() && archive->ok()) archive->expect(mark_carriers() && holds_together());
}

/// Which submaps have not retired follows from the table.
void Skeleton::find_live_submaps(Archive* archive) {
  const bool slides = map_.config.slides();
  for (int32_t k = 0; archive->ok() && k < map_.submaps.size(); ++k) {
    const Submap& submap = map_.submaps.at(k);
    if (submap.place.retired) continue;
    if (submap.is_loop) {
      archive->need("max_loops", loops_.size() + 1, loops_.capacity());
      if (archive->ok()) add_loop(submap.id);
      watch_.take(submap.health);
    } else if (slides) {
      archive->need("window_submaps", windows_.size() + 1, map_.config.window_submaps);
      if (archive->ok()) put_in_order(submap.id);
    }
  }
}

void Skeleton::visit_nodes(Archive* archive) {
  int32_t count = nodes_.size();
  archive->index(&count, 0, kMostCount);
  archive->need("skeleton_capacity", count, std::max<int32_t>(0, nodes_.capacity() - 1));
  if (!archive->ok()) return;
  if (archive->loading()) nodes_.resize(count);
  int64_t windows = 0;
  for (int32_t k = 0; archive->ok() && k < count; ++k) {
    SkeletonNode& node = nodes_[k];
    if (archive->loading()) node = SkeletonNode();
    archive->value(&node.submap);
    archive->index(&node.windows, 1, kMostCount);
    archive->value(&node.owned.first);
    archive->value(&node.owned.last);
    windows += node.windows;
  }
  archive->expect(windows <= map_.submaps.next_id());
}

void Skeleton::visit_edges(Archive* archive) {
  for (int32_t k = 0; archive->ok() && k < map_.submaps.size(); ++k) {
    const Submap& submap = map_.submaps.at(k);
    if (submap.place.retired) continue;
    for (int32_t view = 0; archive->ok() && view < submap.count; ++view) {
      visit_view_edges(archive, submap, &map_.submaps.view(submap, view));
    }
  }
  ties_.visit(archive);
  map_.graph.visit_edges(archive, FactorKind::kTwoView, EdgeOrigin::kPair);
  map_.graph.visit_edges(archive, FactorKind::kChain, EdgeOrigin::kWindow);
  loop_edges_.visit_edges(archive);
  if (archive->loading() && archive->ok()) archive->expect(chains_hold());
}

void Skeleton::visit_view_edges(Archive* archive, const Submap& submap, SubmapView* view) {
  const auto visit_one = [&](FactorKind kind, int32_t* id) {
    map_.graph.visit_edge(archive, kind, id);
    if (!archive->loading() || !archive->ok() || *id < 0) return;
    const Edge& edge = map_.graph.edge(*id);
    archive->expect(view->used && edge.a == submap.place.node && ends_at(*view, edge.b));
  };
  visit_one(FactorKind::kBridge, &view->bridge);
  visit_one(FactorKind::kScaleAnchor, &view->anchor);
}

}  // namespace unisim
