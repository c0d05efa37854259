// SPDX-License-Identifier: MIT
// A session that was destroyed and whose arena is still there.
#include "tests/capi/world.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::test;

namespace {

template <class Struct>
Struct sized() {
  Struct out = {};
  out.struct_size = sizeof out;
  return out;
}

/// What `call` says of this session, by name, for every call of unisim.h that takes one; all other
/// arguments are good.
std::vector<std::pair<const char*, unisim_status>> answers(unisim_session* session, World& world) {
  const Pair pair = world.pair(0);
  unisim_two_view two_view = pair.two_view;
  two_view.depth_i = pair.depth_i.map();
  two_view.depth_j = pair.depth_j.map();
  const Views views = world.views(ids(0, 8));
  const unisim_submap submap = views.submap();
  const std::vector<double> ratios(8, 0.0);
  auto update = sized<unisim_submap_update>();
  update.count = 8;
  update.T_submap_kf = views.T_submap_kf.data();
  update.log_depth_ratio = ratios.data();
  auto keyframe = sized<unisim_keyframe>();
  keyframe.timestamp_ns = 1000000;
  auto request = sized<unisim_request>();
  auto refused = sized<unisim_request>();
  refused.kind = UNISIM_REQUEST_PAIR;
  refused.count = 2;
  refused.keyframe_ids[1] = 1;
  auto report = sized<unisim_report>();
  auto pose = sized<unisim_pose>();
  auto retired = sized<unisim_retired>();
  auto loop = sized<unisim_loop_info>();
  auto submap_info = sized<unisim_submap_info>();
  auto info = sized<unisim_session_info>();
  auto distance = sized<unisim_distance>();
  distance.j = 1;
  distance.metres = 1.0;
  distance.sigma = 0.01;
  auto unit = sized<unisim_submap_unit>();
  unit.metres = 1.0;
  unit.sigma = 0.1;
  auto scale = sized<unisim_scale>();
  double covariance[49];
  size_t count = 0;
  int32_t id = -1;
  return {{"add_keyframe", unisim_add_keyframe(session, &keyframe, &id)},
          {"add_two_view", unisim_add_two_view(session, &two_view)},
          {"add_submap", unisim_add_submap(session, &submap, &id)},
          {"add_loop", unisim_add_loop(session, &submap, &id)},
          {"update_submap", unisim_update_submap(session, &update)},
          {"next_request", unisim_next_request(session, UNISIM_REQUEST_PAIR, &request)},
          {"reject_request", unisim_reject_request(session, &refused)},
          {"close_window", unisim_close_window(session)},
          {"optimize", unisim_optimize(session, nullptr, &report)},
          {"get_pose", unisim_get_pose(session, 0, &pose)},
          {"get_trajectory", unisim_get_trajectory(session, &pose, 1, &count)},
          {"get_covariance", unisim_get_covariance(session, 1, covariance)},
          {"multiply_covariance",
           unisim_multiply_covariance(session, 0, 1, covariance, covariance + 7)},
          {"add_distance", unisim_add_distance(session, &distance)},
          {"add_submap_unit", unisim_add_submap_unit(session, &unit)},
          {"get_scale", unisim_get_scale(session, 0, &scale)},
          {"next_retired", unisim_next_retired(session, &retired)},
          {"get_loop", unisim_get_loop(session, 0, &loop)},
          {"remove_loop", unisim_remove_loop(session, 0)},
          {"get_submap", unisim_get_submap(session, 0, &submap_info)},
          {"get_info", unisim_get_info(session, &info)},
          {"session_reset", unisim_session_reset(session)}};
}

}  // namespace

TEST_CASE("a destroyed session answers every call with invalid argument") {
  World world(20, 3U);
  Host host(small_windows(0));
  host.feed(world, 10);
  unisim_session_destroy(host);
  unisim_session_destroy(host);
  for (const auto& [name, status] : answers(host, world)) {
    INFO(name);
    CHECK(status == UNISIM_ERR_INVALID_ARGUMENT);
  }
}

TEST_CASE("the arena of a destroyed session takes another one") {
  const unisim_config config = small_windows(0);
  size_t size = 0;
  REQUIRE(unisim_arena_size(&config, &size) == UNISIM_OK);
  std::vector<unsigned char> arena(size);
  unisim_session* session = nullptr;
  for (int life = 0; life < 2; ++life) {
    REQUIRE(unisim_session_create(&session, &config, arena.data(), size) == UNISIM_OK);
    auto info = sized<unisim_session_info>();
    CHECK(unisim_get_info(session, &info) == UNISIM_OK);
    unisim_session_destroy(session);
    CHECK(unisim_get_info(session, &info) == UNISIM_ERR_INVALID_ARGUMENT);
  }
}
