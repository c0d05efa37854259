// SPDX-License-Identifier: MIT
// A sliding window never fills: rings, streaming out, keyframes that no window comes for.
#include <algorithm>
#include <cstring>
#include <map>
#include <string>

#include "tests/capi/world.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::test;

namespace {

constexpr int32_t kKept = 88;  // (window_submaps + 9) window_size

unisim_config small_config() {
  unisim_config config = small_windows(2);
  config.skeleton_capacity = 8;
  config.max_keyframes = 2;  // as few as there may be
  config.max_loops = 3;
  return config;
}

unisim_status read_pose(const Host& host, int32_t id) {
  unisim_pose pose = {};
  pose.struct_size = sizeof pose;
  return unisim_get_pose(host, id, &pose);
}

/// What a host keeps of what it is offered.
struct Book {
  std::map<int32_t, unisim_retired> keyframes;
  std::map<int32_t, unisim_retired> submaps;
  bool once = true;

  void read(const Host& host) {
    unisim_retired r = {};
    r.struct_size = sizeof r;
    while (unisim_next_retired(host, &r) == UNISIM_OK) {
      auto& known = r.kind == UNISIM_RETIRED_KEYFRAME ? keyframes : submaps;
      const int32_t id = r.kind == UNISIM_RETIRED_KEYFRAME ? r.keyframe_id : r.submap_id;
      once = once && known.emplace(id, r).second;
    }
  }
  unisim::Sim3 pose(const Host& host, int32_t keyframe) const {
    unisim::Sim3 T = from_c(keyframes.at(keyframe).T);
    int32_t submap = keyframes.at(keyframe).submap_id;
    for (auto at = submaps.find(submap); at != submaps.end(); at = submaps.find(submap)) {
      T = from_c(at->second.T) * T;
      submap = at->second.anchor_id;
    }
    unisim_submap_info info = {};
    info.struct_size = sizeof info;
    REQUIRE(unisim_get_submap(host, submap, &info) == UNISIM_OK);
    return from_c(info.T_world_submap) * T;
  }
};

}  // namespace

TEST_CASE("a session of the usual size needs less than 4 MB without depth, however long it runs") {
  unisim_config config = default_config();
  config.window_submaps = 2;
  unisim_arena_part parts[32];
  size_t count = 0;
  REQUIRE(unisim_arena_parts(&config, parts, 32, &count) == UNISIM_OK);
  size_t bytes = 0;
  for (size_t k = 0; k < count; ++k) {
    if (std::strcmp(parts[k].name, "depth") != 0) bytes += parts[k].bytes;
  }
  CHECK(bytes < 4000000);
}

TEST_CASE("one byte less than a sliding window needs is out of memory") {
  const unisim_config config = small_config();
  size_t size = 0;
  REQUIRE(unisim_arena_size(&config, &size) == UNISIM_OK);
  std::vector<unsigned char> arena(size);
  unisim_session* session = nullptr;
  CHECK(unisim_session_create(&session, &config, arena.data(), size - 1) ==
        UNISIM_ERR_OUT_OF_MEMORY);
  CHECK(unisim_session_create(&session, &config, arena.data(), size) == UNISIM_OK);
}

TEST_CASE("the newest keyframes stay readable, older ones say that they are gone") {
  World world(300, 12U);
  Host host(small_config());
  feed(host, world, 300);
  const unisim_session_info info = host.info();
  CHECK(info.keyframes == 300);
  CHECK(info.first_keyframe == 300 - kKept);
  CHECK(read_pose(host, info.first_keyframe - 1) == UNISIM_ERR_RETIRED);
  CHECK(read_pose(host, 0) == UNISIM_ERR_RETIRED);
  CHECK(read_pose(host, 300) == UNISIM_ERR_INVALID_ARGUMENT);
  for (int32_t id = info.first_keyframe; id < 300; ++id) CHECK(read_pose(host, id) == UNISIM_OK);
  std::vector<unisim_pose> poses(kKept);
  poses[0].struct_size = sizeof poses[0];
  size_t count = 0;
  REQUIRE(unisim_get_trajectory(host, poses.data(), poses.size(), &count) == UNISIM_OK);
  CHECK(count == kKept);
  CHECK(poses[0].keyframe_id == info.first_keyframe);
  CHECK(info.retired_unread == info.first_keyframe);
}

TEST_CASE("what retires is offered once, and tells every pose after later corrections") {
  World world(200, 12U, kNoise);
  unisim_config config = small_config();
  config.max_keyframes = 250;  // all stay readable, to compare with
  Host host(config);
  Book book;
  for (int32_t k = 0; k < 180; ++k) {
    feed(host, world, 1);
    book.read(host);
  }
  REQUIRE(host.add_loop(world.views(both(0, 170))) >= 0);
  feed(host, world, 20);
  book.read(host);
  host.optimize();
  CHECK(book.once);
  CHECK(book.submaps.size() > 5);
  const auto retired = static_cast<int32_t>(book.keyframes.size());
  CHECK(retired == host.info().retired_keyframes);
  CHECK(host.info().retired_unread == 0);
  for (int32_t id = 0; id < retired; ++id) {
    const unisim::Sim3 ours = from_c(host.pose(id).T_world_kf);
    CHECK(sim3_log(between(ours, book.pose(host, id))).cwiseAbs().maxCoeff() < 1e-9);
  }
}

TEST_CASE("the whole trajectory can be told long after it has left the ring") {
  World world(400, 12U);
  Host host(small_config());
  Book book;
  for (int32_t k = 0; k < 400; ++k) {
    feed(host, world, 1);
    book.read(host);
  }
  const unisim::Sim3 first = book.pose(host, 0);
  double worst = 0.0;
  double unit = 0.0;
  for (int32_t id = 100; id < 370; ++id) {
    const unisim::Sim3 ours = between(first, book.pose(host, id));
    const unisim::Vec3 truth = between(world.truth(0), world.truth(id)).t;
    if (unit == 0.0) unit = ours.t.norm() / truth.norm();
    worst = std::max(worst, (ours.t / unit - truth).norm());
  }
  CHECK(worst < 1e-3);
}

TEST_CASE("keyframes that no window comes for are closed by their pairs") {
  World world(400, 12U);
  Host host(small_config());
  feed_pairs(host, world, 400);
  const unisim_session_info info = host.info();
  CHECK(info.posed_keyframes == 400);
  CHECK(info.stretches > 20);
  CHECK(info.first_keyframe == 400 - kKept);
  CHECK(host.optimize().keyframes <= 10 * 8);
  CHECK(host.pose(399).confidence == 1);
}

TEST_CASE("windows go on after a stretch without them") {
  World world(300, 12U);
  Host host(small_config());
  feed(host, world, 60);
  feed_pairs(host, world, 120);
  host.optimize();
  feed(host, world, 120);
  CHECK(host.info().stretches > 0);
  CHECK(host.optimize().final_cost < 1e-6);
}

TEST_CASE("keyframes without pairs, and pairs refused for ever, are no error") {
  const bool refuse = GENERATE(false, true);
  World world(400, 12U);
  Host host(small_config());
  feed(host, world, 50);
  for (int32_t k = 0; k < 300; ++k) {
    host.add_keyframe();
    if (refuse) REQUIRE(host.reject_pair() == UNISIM_OK);
  }
  CHECK(host.info().keyframes == 350);
  CHECK(host.info().pairs_refused > 200);
  for (int k = 0; k < 20; ++k) {
    const int32_t id = host.add_keyframe();
    while (host.next(UNISIM_REQUEST_PAIR).kind == UNISIM_REQUEST_PAIR) {
      const int32_t i = host.next(UNISIM_REQUEST_PAIR).keyframe_ids[0];
      REQUIRE(host.add_pair(world.pair(i)) == UNISIM_OK);
    }
    CHECK(host.pose(id).confidence >= 1);
  }
}

TEST_CASE("parts that nothing joins make room for newer ones") {
  World world(500, 12U);
  Host host(small_config());
  for (int32_t id = 0; id < 500; ++id) {
    host.add_keyframe();
    if (id == 0) continue;
    // A loss every nine keyframes: no segment has more than one window.
    if (id % 9 == 0) {
      REQUIRE(host.reject_pair() == UNISIM_OK);
    } else {
      REQUIRE(host.add_pair(world.pair(id - 1)) == UNISIM_OK);
    }
  }
  CHECK(host.info().keyframes == 500);
  CHECK(read_pose(host, 499) == UNISIM_OK);
  CHECK(host.info().segments > 40);
}

TEST_CASE("a loop to a place that is gone says so and changes nothing") {
  World world(200, 12U);
  Host host(small_config());
  feed(host, world, 200);
  const Views views = world.views(both(3, 190));
  const unisim_submap submap = views.submap();
  int32_t id = -7;
  CHECK(unisim_add_loop(host, &submap, &id) == UNISIM_ERR_RETIRED);
  CHECK(id == -7);
  CHECK(host.info().loops == 0);
  CHECK(host.optimize().final_cost < 1e-8);
}

TEST_CASE("loops without number are taken, the newest are known by their id") {
  World world(200, 12U);
  Host host(small_config());
  feed(host, world, 120);
  int32_t first = -1;
  for (int32_t k = 0; k < 40; ++k) {
    const int32_t loop = host.add_loop(world.views(both(40 + k, 112)));
    if (first < 0) first = loop;
    REQUIRE(loop >= 0);
  }
  feed(host, world, 80);
  for (int32_t k = 0; k < 40; ++k) REQUIRE(host.add_loop(world.views(both(120 + k, 192))) >= 0);
  CHECK(host.info().loops == 80);
  unisim_submap_info info = {};
  info.struct_size = sizeof info;
  CHECK(unisim_get_submap(host, first, &info) == UNISIM_ERR_RETIRED);
  CHECK(host.optimize().final_cost < 1e-6);
}
