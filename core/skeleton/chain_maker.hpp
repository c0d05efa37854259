// SPDX-License-Identifier: MIT
// Turns what lies between two nodes into one chain edge.
#pragma once

#include <cstdint>

#include "core/map/map.hpp"
#include "core/solve/factor/condenser.hpp"

namespace unisim {

/// Copies a piece of the map into a small graph and condenses that.
class ChainMaker {
 public:
  ChainMaker(Arena& arena, const GraphCapacity& capacity, int32_t map_nodes, Map& map)
      : map_(map), condenser_(arena, capacity), local_node_(arena.take<int32_t>(map_nodes)) {}

  /// Relative pose of two neighbouring windows out of everything between their origins but loops.
  /// false: nothing joins them there
  bool between_windows(const Submap& m, const Submap& n, ChainLink* link);

  /// Relative pose of the two nodes that a loop joins: its views before `split` are taken as rigid
  /// under a, the others under b. false: the loop does not determine it
  bool of_loop(const Submap& loop, int32_t a, int32_t b, int32_t split, ChainLink* link);

 private:
  bool load_between(const Submap& m, const Submap& n);
  void guess(const Submap& m, const Submap& n, ChainLink* link) const;
  bool takes_part(const Submap& loop, int32_t k) const;
  int32_t middle_view(const Submap& loop, int32_t begin, int32_t end) const;
  bool add_rigid_view(const Submap& loop, int32_t k, const Sim3& T_node_kf, int32_t from,
                      int32_t to);

  Map& map_;
  Condenser condenser_;
  Span<int32_t> local_node_;  // node of the map -> node of the small graph, -1: not in it
};

}  // namespace unisim
