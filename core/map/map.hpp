// SPDX-License-Identifier: MIT
// The map: keyframes, submaps and the graph that ties them together.
#pragma once

#include "core/base/invariants.hpp"
#include "core/graph/graph.hpp"
#include "core/map/keyframe_ring.hpp"
#include "core/map/metric_scale.hpp"
#include "core/map/submap_table.hpp"
#include "core/session_config.hpp"

namespace unisim {

/// What all parts of a session work on together. They hold a reference to it, so it stays where it
/// was made.
struct Map {
  Map(Arena& arena, const SessionConfig& map_config, const SessionCapacity& capacity)
      : config(map_config),
        keyframes(arena.begin_part("keyframes"), capacity.keyframes, config.first_keyframe_id),
        submaps(arena.begin_part("submaps"), capacity.submaps, config.first_submap_id),
        graph(arena.begin_part("graph"), capacity.graph),
        metric(arena.begin_part("metric"), capacity.graph.nodes) {}
  Map(const Map&) = delete;
  Map& operator=(const Map&) = delete;

  bool holds(Status status) { return invariants.holds(status); }
  bool broken() const { return invariants.broken(); }

  /// T_world_submap of a submap that has a node.
  Sim3 submap_pose(const Submap& submap) const {
    const Sim3& T_world_node = graph.pose(submap.place.node);
    return submap.place.own_node ? T_world_node : T_world_node * submap.place.T_node_submap;
  }
  /// T_world_kf of a keyframe that is posed().
  Sim3 keyframe_pose(int32_t id) const {
    const Keyframe& keyframe = keyframes[id];
    if (!keyframe.retired()) return graph.pose(keyframe.node);
    return submap_pose(submaps[keyframe.owner]) * keyframe.T_owner_kf;
  }

  SessionConfig config;
  Invariants invariants;
  KeyframeRing keyframes;
  SubmapTable submaps;
  Graph graph;
  MetricScale metric;
};

}  // namespace unisim
