// SPDX-License-Identifier: MIT
// Submaps saved and loaded, with their views and what they share.
#include "core/map/submap_table.hpp"
#include "core/session_config.hpp"

namespace unisim {
namespace {

void visit_range(Archive* archive, KeyframeRange* range) {
  archive->index(&range->first, 0, kLastId);
  archive->index(&range->last, -1, kLastId);
}

void visit_quality(Archive* archive, SubmapQuality* quality) {
  archive->value(&quality->center_sigma);
  archive->value(&quality->scatter);
  archive->finite(&quality->multiplier);
  archive->expect(quality->multiplier >= 0.0);
}

/// What takes no part is not looked at again.
void visit_view(Archive* archive, SubmapView* view) {
  archive->flag(&view->used);
  archive->flag(&view->measured);
  archive->index(&view->segment, -1, kLastId);
  archive->log_ratio(&view->log_rho);
  if (view->used) archive->pose(&view->T_submap_kf);
}

/// Those of one submap stand together, one for each of its views at most.
bool comes_before(const SharedKeyframe& a, const SharedKeyframe& b) {
  return a.n < b.n || (a.n == b.n && a.view_n < b.view_n);
}

}  // namespace

void visit_health(Archive* archive, LoopHealth* health) {
  archive->value(&health->norm);
  archive->index(&health->strikes, 0, kLastId);
  archive->value(&health->retry_at);
  archive->index(&health->wait, 0, kLastId / 2);
  archive->flag(&health->suspended);
}

void SubmapTable::visit(Archive* archive, Graph* graph) {
  archive->index(&next_id_, 0, kMostId);
  int32_t count = order_.size();
  archive->index(&count, 0, next_id_);
  for (int32_t k = 0; archive->ok() && k < count; ++k) {
    bool is_loop = !archive->loading() && at(k).is_loop;
    archive->flag(&is_loop);
    if (archive->loading()) {
      archive->need(is_loop ? "max_loops" : "max_submaps", (is_loop ? loops_ : windows_) + 1,
                    is_loop ? most_loops_ : most_windows_);
      if (!archive->ok()) return;
      static_cast<void>(take_slot(is_loop));
    }
    visit_submap(archive, graph, &at(k));
    archive->expect(k == 0 || at(k - 1).id < at(k).id);
  }
}

void SubmapTable::visit_submap(Archive* archive, Graph* graph, Submap* submap) {
  archive->index(&submap->id, 0, std::max<int32_t>(0, next_id_ - 1));
  archive->index(&submap->segment, 0, kLastId);
  archive->flag(&submap->removed);
  archive->index(&submap->loop_edge, -1, kLastId);
  archive->index(&submap->count, 1, views_each_);
  archive->index(&submap->origin, 0, submap->count - 1);
  visit_range(archive, &submap->window);
  visit_range(archive, &submap->owned);
  visit_quality(archive, &submap->quality);
  visit_health(archive, &submap->health);
  SubmapPlace& place = submap->place;
  archive->flag(&place.retired);
  archive->flag(&place.own_node);
  if (place.own_node) {
    const bool is_skeleton = place.retired && !submap->is_loop;
    graph->visit_node(archive, is_skeleton ? NodeKind::kSkeleton : NodeKind::kSubmap, &place.node);
  } else {
    archive->value(&place.node);
    archive->pose(&place.T_node_submap);
  }
  archive->expect(place.retired ? !(submap->is_loop && place.own_node) : place.own_node);
  visit_keyframes(archive, *submap);
  if (place.retired || !archive->ok()) return;
  if (archive->loading()) {
    archive->need(submap->is_loop ? "max_loops" : "window_submaps", 1, free_views_.size());
    if (!archive->ok()) return;
    take_views(submap);
  }
  for (int32_t k = 0; k < submap->count; ++k) {
    visit_view(archive, &view(*submap, k));
    if (archive->loading()) view(*submap, k).keyframe = keyframe(*submap, k);
  }
}

void SubmapTable::visit_keyframes(Archive* archive, const Submap& submap) {
  for (int32_t k = 0; archive->ok() && k < submap.count; ++k) {
    int32_t& id = ids_[submap.first_id + k];
    archive->index(&id, 0, kLastId);
    archive->expect(k == 0 || keyframe(submap, k - 1) < id);
  }
}

/// Is this one of the windows that have views?
bool SubmapTable::has_view(int32_t id, int32_t k) const {
  if (!has(id)) return false;
  const Submap& submap = (*this)[id];
  return !submap.is_loop && !submap.place.retired && k >= 0 && k < submap.count;
}

/// Scale edge of the pair of submaps, when an earlier keyframe that they share has it. -1: none
int32_t SubmapTable::scale_of_pair(int32_t k) const {
  for (int32_t other = k - 1; other >= 0 && shared_[other].n == shared_[k].n; --other) {
    if (shared_[other].m == shared_[k].m) return shared_[other].scale;
  }
  return -1;
}

void SubmapTable::visit_shared(Archive* archive, Graph* graph) {
  int32_t count = shared_.size();
  archive->index(&count, 0, kMostId);
  archive->need("window_overlap", count, shared_.capacity());
  if (!archive->ok()) return;
  if (archive->loading()) shared_.resize(count);
  for (int32_t k = 0; archive->ok() && k < count; ++k) {
    SharedKeyframe& shared = shared_[k];
    if (archive->loading()) shared = SharedKeyframe();
    archive->value(&shared.m);
    archive->value(&shared.n);
    archive->value(&shared.view_m);
    archive->value(&shared.view_n);
    archive->log_ratio(&shared.log_c);
    archive->expect(has_view(shared.m, shared.view_m) && has_view(shared.n, shared.view_n));
    archive->expect(shared.m < shared.n && (k == 0 || comes_before(shared_[k - 1], shared)));
    if (!archive->ok()) return;
    const int32_t m = (*this)[shared.m].place.node;
    const int32_t n = (*this)[shared.n].place.node;
    graph->visit_edge(archive, FactorKind::kTie, m, n, &shared.tie);
    const int32_t scale = scale_of_pair(k);
    if (scale < 0) graph->visit_edge(archive, FactorKind::kScale, m, n, &shared.scale);
    if (archive->loading() && scale >= 0) shared.scale = scale;
  }
}

}  // namespace unisim
