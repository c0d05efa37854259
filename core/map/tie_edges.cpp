// SPDX-License-Identifier: MIT
// Edges between submaps that see the same keyframes: tie and scale.
#include "core/map/tie_edges.hpp"

#include <algorithm>

#include "core/base/math.hpp"
#include "core/depth/nth_element.hpp"
#include "core/graph/tie.hpp"

namespace unisim {

Sim3 TieEdges::measurement(const SharedKeyframe& shared) const {
  const SubmapView& view = map_.submaps.view(map_.submaps[shared.m], shared.view_m);
  if (map_.config.preset == Preset::kPaper) return view.T_submap_kf;
  return tie_measurement(view.T_submap_kf, math::exp(shared.log_c));
}

/// An edge is as good as the worse of the two.
double TieEdges::multiplier(int32_t m, int32_t n) const {
  return std::min(map_.submaps[m].quality.multiplier, map_.submaps[n].quality.multiplier);
}

void TieEdges::add(int32_t id) {
  if (map_.broken()) return;
  const Submap& submap = map_.submaps[id];
  for (int32_t k = 0; k < submap.count; ++k) {
    const SubmapView& view = map_.submaps.view(submap, k);
    if (view.shared_submap < 0 || !take_pair(view.shared_submap, id)) continue;
    SharedKeyframe shared;
    shared.m = view.shared_submap;
    shared.n = id;
    shared.view_m = view.shared_view;
    shared.view_n = k;
    shared.log_c = view.log_c;
    if (map_.config.factor(FactorKind::kTie).enabled) {
      const EdgeWeight weight =
          map_.config.edge_weight(FactorKind::kTie, multiplier(shared.m, id), EdgeOrigin::kWindow);
      map_.holds(map_.graph.add_tie(map_.submaps[shared.m].place.node, submap.place.node,
                                    measurement(shared), view.T_submap_kf, weight, &shared.tie));
    }
    if (!map_.submaps.add_shared(shared)) map_.holds(Status::kInternal);
  }
  if (!map_.config.factor(FactorKind::kScale).enabled) return;
  for (const SharedKeyframe& shared : map_.submaps.shared()) {
    if (shared.n == id && shared.scale < 0) add_scale(shared.m, id);
  }
}

/// The solver's memory is declared for a number of submap pairs; windows cut by
/// unisim_close_window() at every turn could ask for more, and then go without a tie.
bool TieEdges::take_pair(int32_t m, int32_t n) {
  for (const SharedKeyframe& shared : map_.submaps.shared()) {
    if (shared.m == m && shared.n == n) return true;
  }
  if (pairs_ == capacity_) return false;
  ++pairs_;
  return true;
}

/// One edge stands for all keyframes that the two share.
void TieEdges::add_scale(int32_t m, int32_t n) {
  const EdgeWeight weight =
      map_.config.edge_weight(FactorKind::kScale, multiplier(m, n), EdgeOrigin::kWindow);
  int32_t edge = -1;
  if (!map_.holds(map_.graph.add_scale(map_.submaps[m].place.node, map_.submaps[n].place.node,
                                       median_log_c(m, n), weight, &edge))) {
    return;
  }
  for (SharedKeyframe& shared : map_.submaps.shared()) {
    if (shared.m == m && shared.n == n) shared.scale = edge;
  }
}

double TieEdges::median_log_c(int32_t m, int32_t n) const {
  double values[kMaxViews];
  int32_t count = 0;
  for (const SharedKeyframe& shared : map_.submaps.shared()) {
    if (shared.m == m && shared.n == n) values[count++] = shared.log_c;
  }
  return median({values, count});
}

void TieEdges::rescale(int32_t submap, Span<const double> log_depth_ratio) {
  for (SharedKeyframe& shared : map_.submaps.shared()) {
    if (shared.m == submap) shared.log_c += log_depth_ratio[shared.view_m];
    if (shared.n == submap) shared.log_c -= log_depth_ratio[shared.view_n];
  }
  for (const SharedKeyframe& shared : map_.submaps.shared()) {
    if (shared.m != submap && shared.n != submap) continue;
    const double weight = multiplier(shared.m, shared.n);
    if (shared.tie >= 0) {
      const Submap& n = map_.submaps[shared.n];
      const Sim3& T_submap_n_kf = map_.submaps.view(n, shared.view_n).T_submap_kf;
      map_.holds(map_.graph.set_tie_measurement(shared.tie, measurement(shared), T_submap_n_kf));
      map_.holds(map_.graph.set_multiplier(shared.tie, weight));
    }
    if (shared.scale >= 0) {
      map_.holds(map_.graph.set_log_ratio(shared.scale, median_log_c(shared.m, shared.n)));
      map_.holds(map_.graph.set_multiplier(shared.scale, weight));
    }
  }
}

void TieEdges::drop(int32_t submap) {
  for (SharedKeyframe& shared : map_.submaps.shared()) {
    if (shared.m != submap && shared.n != submap) continue;
    if (shared.tie >= 0) map_.holds(map_.graph.remove_edge(shared.tie));
    shared.tie = -1;
    const int32_t scale = shared.scale;
    if (scale < 0) continue;
    for (SharedKeyframe& same : map_.submaps.shared()) {
      if (same.scale == scale) same.scale = -1;
    }
    map_.holds(map_.graph.remove_edge(scale));
  }
  map_.submaps.drop_shared(submap);
  count_pairs();
}

void TieEdges::count_pairs() {
  const SubmapTable& submaps = map_.submaps;
  const Span<const SharedKeyframe> shared = submaps.shared();
  pairs_ = 0;
  for (int32_t k = 0; k < shared.size(); ++k) {
    bool counted = false;
    for (int32_t i = 0; i < k; ++i) {
      counted = counted || (shared[i].m == shared[k].m && shared[i].n == shared[k].n);
    }
    pairs_ += counted ? 0 : 1;
  }
}

void TieEdges::visit(Archive* archive) {
  map_.submaps.visit_shared(archive, &map_.graph);
  if (!archive->loading() || !archive->ok()) return;
  count_pairs();
  archive->need("window_overlap", pairs_, capacity_);
}

}  // namespace unisim
