// SPDX-License-Identifier: MIT
// A straight walk in a map that has no session: keyframes, windows and loops put in by hand.
#pragma once

#include <vector>

#include "core/map/map.hpp"
#include "core/map/tie_edges.hpp"
#include "core/map/view_edges.hpp"
#include "core/skeleton/skeleton.hpp"
#include "tests/support/catch.hpp"

namespace unisim_test {

/// Windows of four keyframes, two in the sliding window, four nodes of skeleton.
inline unisim::SessionConfig walk_config() {
  unisim::SessionConfig config;
  config.window_size = 4;
  config.window_overlap = 1;
  config.max_keyframes = 64;
  config.max_loops = 16;
  config.window_submaps = 2;
  config.skeleton_capacity = 4;
  return config;
}

/// Everything measured is exact, so that poses stay where they are put.
class MapWalk {
 public:
  explicit MapWalk(const unisim::SessionConfig& config = walk_config())
      : capacity_(unisim::session_capacity(config)),
        memory_(size_t{4} << 20),
        arena_(memory_.data(), memory_.size()),
        map(arena_, config, capacity_),
        ties(map, capacity_.window_pairs),
        watch(map),
        skeleton(arena_, capacity_, map, ties, watch) {
    REQUIRE(arena_.ok());
  }

  /// One step of length 1 along z.
  static unisim::Sim3 pose_at(int32_t keyframe) {
    unisim::Sim3 T;
    T.t = {0.0, 0.0, static_cast<double>(keyframe)};
    return T;
  }

  void add_keyframes(int32_t count) {
    for (int32_t k = 0; k < count; ++k) add_keyframe();
  }
  void add_keyframe() {
    const int32_t id = map.keyframes.append(map.keyframes.size());
    unisim::Keyframe& keyframe = map.keyframes[id];
    keyframe.segment = segment;
    require(map.graph.add_node(unisim::NodeKind::kKeyframe, pose_at(id), &keyframe.node));
    map.keyframes.settle(id);
    if (!map.keyframes.has(id - 1)) return;
    const unisim::Keyframe& before = map.keyframes[id - 1];
    if (before.node < 0 || before.segment != segment) return;
    int32_t edge = -1;
    require(map.graph.add_two_view(
        before.node, keyframe.node, pose_at(1),
        map.config.edge_weight(unisim::FactorKind::kTwoView, 1.0, unisim::EdgeOrigin::kPair),
        &edge));
  }

  /// Window over the newest keyframes. @return its id
  int32_t add_window(int32_t count = 4) {
    const int32_t first = map.keyframes.size() - count;
    skeleton.make_room(false);
    const int32_t id = append(false, ids_from(first, count), unisim::Sim3());
    map.submaps[id].window = {first, first + count - 1};
    for (int32_t k = 0; k < count; ++k) {
      map.keyframes[first + k].best_submap = id;
      ++map.keyframes[first + k].window_count;
    }
    skeleton.add_window(id);
    return id;
  }
  /// New keyframes and a window over them and the newest before.
  int32_t walk_on() {
    const bool starts = map.keyframes.size() == 0;
    add_keyframes(starts ? 4 : 3);
    return add_window();
  }

  /// Loop that sees two keyframes from `here` and two from `there` on. @param miss how far off it
  /// sees the second place: T_seen = miss T_true
  int32_t add_loop(int32_t here, int32_t there, const unisim::Sim3& miss = unisim::Sim3()) {
    skeleton.make_room(true);
    const int32_t id = append(true, {here, here + 1, there, there + 1}, miss);
    skeleton.add_loop(id);
    return id;
  }

  int32_t chain_edges(unisim::EdgeOrigin origin) const {
    int32_t count = 0;
    for (int32_t id = 0; id < map.graph.edge_end(); ++id) {
      const bool chain =
          map.graph.has_edge(id) && map.graph.edge(id).kind == unisim::FactorKind::kChain;
      count += chain && map.graph.edge(id).origin == origin ? 1 : 0;
    }
    return count;
  }
  static void require(unisim::Status status) { REQUIRE(status == unisim::Status::kOk); }

 private:
  static std::vector<int32_t> ids_from(int32_t first, int32_t count) {
    std::vector<int32_t> ids;
    for (int32_t k = 0; k < count; ++k) ids.push_back(first + k);
    return ids;
  }

  int32_t append(bool is_loop, const std::vector<int32_t>& ids, const unisim::Sim3& miss) {
    const auto count = static_cast<int32_t>(ids.size());
    const int32_t id = map.submaps.append(is_loop, count);
    unisim::Submap& submap = map.submaps[id];
    submap.segment = segment;
    submap.origin = is_loop ? 0 : count / 2;
    const int32_t origin = ids[static_cast<size_t>(submap.origin)];
    require(map.graph.add_node(unisim::NodeKind::kSubmap, map.keyframe_pose(origin),
                               &submap.place.node));
    for (int32_t k = 0; k < count; ++k) {
      const int32_t keyframe = ids[static_cast<size_t>(k)];
      map.submaps.set_keyframe(submap, k, keyframe);
      unisim::SubmapView& view = map.submaps.view(submap, k);
      view.T_submap_kf = unisim::between(pose_at(origin), pose_at(keyframe));
      if (k >= 2 && is_loop) view.T_submap_kf = miss * view.T_submap_kf;
      view.segment = segment;
      view.measured = view.used = true;
      unisim::add_view_edges(map, submap, &view);
    }
    return id;
  }

  unisim::SessionCapacity capacity_;
  std::vector<unsigned char> memory_;
  unisim::Arena arena_;

 public:
  unisim::Map map;
  unisim::TieEdges ties;
  unisim::LoopWatch watch;
  unisim::Skeleton skeleton;
  int32_t segment = 0;  ///< of what comes
};

}  // namespace unisim_test
