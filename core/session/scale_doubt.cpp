// SPDX-License-Identifier: MIT
// Pairs whose scale is a guess: what windows over them count, and how a loop settles it.
#include <algorithm>

#include "core/session.hpp"

namespace unisim {

/// Depth may agree all over a window that a pair with a guessed scale cuts in two: what was guessed
/// there is in both halves of it. A loop is evidence of its own.
double Session::window_multiplier(const Submap& submap) const {
  double sigma = submap.quality.center_sigma;
  for (int32_t k = submap.window.first + 1; !submap.is_loop && k <= submap.window.last; ++k) {
    if (map_.keyframes.has(k)) sigma = std::max(sigma, map_.keyframes[k].log_scale_sigma);
  }
  return quality_multiplier(sigma);
}

void Session::weigh_views(const Submap& submap) {
  for (int32_t k = 0; k < submap.count; ++k) {
    const SubmapView& view = map_.submaps.view(submap, k);
    for (const int32_t edge : {view.bridge, view.anchor}) {
      if (edge >= 0) holds(map_.graph.set_multiplier(edge, submap.quality.multiplier));
    }
  }
}

/// The scale over these keyframes is measured now. A loop says how large two places are beside each
/// other, and so everything between them.
void Session::settle_scale(const KeyframeRange& between) {
  bool any = false;
  for (int32_t k = between.first + 1; k <= between.last; ++k) {
    if (!map_.keyframes.has(k) || map_.keyframes[k].log_scale_sigma == 0.0) continue;
    map_.keyframes[k].log_scale_sigma = 0.0;
    any = true;
  }
  if (!any) return;
  constexpr double kSameDepth[kMaxViews] = {};
  for (int32_t position = 0; position < map_.submaps.size(); ++position) {
    Submap& window = map_.submaps.at(position);
    if (window.is_loop || window.place.retired) continue;
    window.quality.multiplier = window_multiplier(window);
    weigh_views(window);
    ties_.rescale(window.id, {kSameDepth, window.count});
  }
}

}  // namespace unisim
