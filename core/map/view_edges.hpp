// SPDX-License-Identifier: MIT
// Edges between a submap and the keyframes it sees: bridge and scale_anchor.
#pragma once

#include "core/map/map.hpp"

namespace unisim {

/// What a bridge edge measures.
Sim3 view_measurement(const SessionConfig& config, const SubmapView& view);

/// Add the edges of a view whose keyframe is posed. A retired keyframe is held through its owner:
/// T_i = S_owner X_i.
void add_view_edges(Map& map, const Submap& submap, SubmapView* view);

/// Take the edges of a view out of the graph.
void drop_view_edges(Map& map, SubmapView* view);

}  // namespace unisim
