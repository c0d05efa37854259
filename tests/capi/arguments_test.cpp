// SPDX-License-Identifier: MIT
// Every argument is checked; a refused call leaves the session as it was.
#include <cmath>
#include <limits>

#include "tests/capi/world.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::test;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Ten keyframes with pairs in windows of six; window 0..5 is open, as is the pair (9, 10).
struct Fixture {
  Fixture() : world(20, 5U), host(config()) {
    for (int32_t id = 0; id < 10; ++id) {
      host.add_keyframe();
      if (id > 0) REQUIRE(host.add_pair(world.pair(id - 1)) == UNISIM_OK);
    }
    host.add_keyframe();
  }
  static unisim_config config() {
    unisim_config config = default_config();
    config.window_size = 6;
    config.max_keyframes = 20;
    return config;
  }
  World world;
  Host host;
};

/// The session answers `status` and then takes the good pair and the good window as if nothing was.
void check_untouched(Fixture& f, unisim_status status, unisim_status expected) {
  CHECK(status == expected);
  const unisim_session_info info = f.host.info();
  CHECK(info.keyframes == 11);
  CHECK(info.posed_keyframes == 10);
  CHECK(info.submaps == 0);
  CHECK(info.pairs_refused == 0);
  CHECK(info.submaps_refused == 0);
  CHECK(f.host.add_pair(f.world.pair(9)) == UNISIM_OK);
  CHECK(f.host.add_submap(f.world.views({0, 1, 2, 3, 4, 5})) == 0);
  CHECK(f.host.optimize().final_cost < 1e-8);
}

}  // namespace

TEST_CASE_METHOD(Fixture, "add_two_view refuses bad numbers and ids") {
  Pair pair = world.pair(9);
  unisim_two_view& t = pair.two_view;
  unisim_status expected = UNISIM_ERR_INVALID_ARGUMENT;
  SECTION("NaN translation") { t.T_i_j.t[1] = kNan; }
  SECTION("infinite translation") { t.T_i_j.t[2] = kInfinity; }
  SECTION("NaN quaternion") { t.T_i_j.q[0] = kNan; }
  SECTION("quaternion of length 2") {
    for (double& q : t.T_i_j.q) q *= 2.0;
  }
  SECTION("zero quaternion") {
    for (double& q : t.T_i_j.q) q = 0.0;
  }
  SECTION("scale other than 1") { t.T_i_j.s = 1.1; }
  SECTION("NaN scale") { t.T_i_j.s = kNan; }
  SECTION("NaN center_sigma") { t.center_sigma = kNan; }
  SECTION("negative center_sigma") { t.center_sigma = -1.0; }
  SECTION("not consecutive") { t.i = 8; }
  SECTION("negative ids") {
    t.i = -1;
    t.j = 0;
  }
  SECTION("largest id") {
    t.i = std::numeric_limits<int32_t>::max();
    t.j = std::numeric_limits<int32_t>::min();
  }
  SECTION("given before") {
    t.i = 3;
    t.j = 4;
  }
  SECTION("keyframe not there yet") {
    t.i = 10;
    t.j = 11;
    expected = UNISIM_ERR_NOT_READY;
  }
  SECTION("struct too small") {
    t.struct_size = 8;
    expected = UNISIM_ERR_ABI_MISMATCH;
  }
  check_untouched(*this, host.add_pair(pair), expected);
}

TEST_CASE_METHOD(Fixture, "add_two_view waits for the pair before") {
  host.add_keyframe();
  CHECK(host.add_pair(world.pair(10)) == UNISIM_ERR_NOT_READY);
  CHECK(host.add_pair(world.pair(9)) == UNISIM_OK);
  CHECK(host.add_pair(world.pair(10)) == UNISIM_OK);
}

TEST_CASE_METHOD(Fixture, "add_two_view refuses depth maps without pixels") {
  Pair pair = world.pair(9);
  unisim_two_view t = pair.two_view;
  t.depth_i = pair.depth_i.map();
  t.depth_j = pair.depth_j.map();
  SECTION("no pixels") { t.depth_i.depth = nullptr; }
  SECTION("no width") { t.depth_j.width = 0; }
  SECTION("negative height") { t.depth_j.height = -3; }
  SECTION("absurd width") { t.depth_i.width = 1 << 20; }
  check_untouched(*this, unisim_add_two_view(host, &t), UNISIM_ERR_INVALID_ARGUMENT);
}

TEST_CASE_METHOD(Fixture, "add_submap refuses bad views") {
  Views views = world.views({0, 1, 2, 3, 4, 5});
  unisim_submap s = views.submap();
  int32_t id = -7;
  unisim_status expected = UNISIM_ERR_INVALID_ARGUMENT;
  SECTION("no ids") { s.keyframe_ids = nullptr; }
  SECTION("no poses") { s.T_submap_kf = nullptr; }
  SECTION("no depth") { s.depth = nullptr; }
  SECTION("one view") { s.count = 1; }
  SECTION("negative count") { s.count = -1; }
  SECTION("too many views") { s.count = UNISIM_MAX_VIEWS + 1; }
  SECTION("unknown keyframe") { views.ids[5] = 77; }
  SECTION("negative keyframe") { views.ids[0] = -1; }
  SECTION("keyframe twice") { views.ids[1] = 0; }
  SECTION("descending") { std::swap(views.ids[1], views.ids[2]); }
  SECTION("no such window") { views.ids = {0, 1, 2, 3, 4, 6}; }
  SECTION("NaN pose") { views.T_submap_kf[3].t[0] = kNan; }
  SECTION("scale 2") { views.T_submap_kf[2].s = 2.0; }
  SECTION("depth without size") { views.maps[4].height = 0; }
  SECTION("NaN center_sigma") { s.center_sigma = kNan; }
  SECTION("struct too small") {
    s.struct_size = 4;
    expected = UNISIM_ERR_ABI_MISMATCH;
  }
  const unisim_status status = unisim_add_submap(host, &s, &id);
  CHECK(id == -7);
  check_untouched(*this, status, expected);
}

TEST_CASE_METHOD(Fixture, "add_submap waits for the pairs of its window") {
  const Views views = world.views({4, 5, 6, 7, 8, 9});
  const unisim_submap s = views.submap();
  int32_t id = -7;
  Host fresh(config());
  for (int32_t k = 0; k < 6; ++k) fresh.add_keyframe();
  const Views first = world.views({0, 1, 2, 3, 4, 5});
  const unisim_submap early = first.submap();
  CHECK(unisim_add_submap(fresh, &early, &id) == UNISIM_ERR_NOT_READY);
  CHECK(unisim_add_submap(host, &s, nullptr) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_add_submap(host, &s, &id) == UNISIM_OK);
}

TEST_CASE_METHOD(Fixture, "update_submap refuses bad numbers") {
  const Views views = world.views({0, 1, 2, 3, 4, 5});
  REQUIRE(host.add_submap(views) == 0);
  const double cost = host.optimize().final_cost;
  std::vector<double> ratios(6, 0.0);
  std::vector<unisim_sim3> poses = views.T_submap_kf;
  unisim_submap_update u = {};
  u.struct_size = sizeof u;
  u.count = 6;
  u.T_submap_kf = poses.data();
  u.log_depth_ratio = ratios.data();
  REQUIRE(unisim_update_submap(host, &u) == UNISIM_OK);
  SECTION("unknown submap") { u.submap_id = 1; }
  SECTION("refused submap") { u.submap_id = -1; }
  SECTION("other count") { u.count = 5; }
  SECTION("no poses") { u.T_submap_kf = nullptr; }
  SECTION("no ratios") { u.log_depth_ratio = nullptr; }
  SECTION("NaN ratio") { ratios[2] = kNan; }
  SECTION("absurd ratio") { ratios[2] = 1e3; }
  SECTION("NaN pose") { poses[5].q[2] = kNan; }
  SECTION("NaN center_sigma") { u.center_sigma = kNan; }
  CHECK(unisim_update_submap(host, &u) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(host.optimize().initial_cost == Approx(cost).margin(1e-12));
}

TEST_CASE_METHOD(Fixture, "NULL is answered, never followed") {
  int32_t id = 0;
  size_t count = 0;
  double covariance[49];
  unisim_pose pose = {};
  pose.struct_size = sizeof pose;
  unisim_request request = {};
  request.struct_size = sizeof request;
  unisim_session_info info = {};
  info.struct_size = sizeof info;
  unisim_submap_info submap_info = {};
  submap_info.struct_size = sizeof submap_info;
  unisim_keyframe keyframe = {};
  keyframe.struct_size = sizeof keyframe;
  const unisim_status invalid = UNISIM_ERR_INVALID_ARGUMENT;
  CHECK(unisim_config_init(nullptr, sizeof(unisim_config)) == invalid);
  CHECK(unisim_arena_size(nullptr, &count) == invalid);
  CHECK(unisim_arena_parts(nullptr, nullptr, 0, &count) == invalid);
  CHECK(unisim_session_create(nullptr, nullptr, nullptr, 0) == invalid);
  CHECK(unisim_session_reset(nullptr) == invalid);
  unisim_session_destroy(nullptr);
  CHECK(unisim_add_keyframe(nullptr, &keyframe, &id) == invalid);
  CHECK(unisim_add_keyframe(host, nullptr, &id) == invalid);
  CHECK(unisim_add_keyframe(host, &keyframe, nullptr) == invalid);
  CHECK(unisim_add_two_view(host, nullptr) == invalid);
  CHECK(unisim_add_submap(host, nullptr, &id) == invalid);
  CHECK(unisim_add_loop(host, nullptr, &id) == invalid);
  CHECK(unisim_update_submap(host, nullptr) == invalid);
  CHECK(unisim_next_request(host, UNISIM_REQUEST_PAIR, nullptr) == invalid);
  CHECK(unisim_next_request(host, 0, &request) == invalid);
  CHECK(unisim_next_request(host, 8, &request) == invalid);
  CHECK(unisim_reject_request(host, nullptr) == invalid);
  CHECK(unisim_reject_request(host, &request) == invalid);
  CHECK(unisim_close_window(nullptr) == invalid);
  CHECK(unisim_optimize(nullptr, nullptr, nullptr) == invalid);
  CHECK(unisim_get_pose(host, 0, nullptr) == invalid);
  CHECK(unisim_get_pose(host, 99, &pose) == invalid);
  CHECK(unisim_get_pose(host, -1, &pose) == invalid);
  CHECK(unisim_get_pose(host, 10, &pose) == UNISIM_ERR_NOT_READY);
  CHECK(unisim_get_trajectory(host, nullptr, 3, &count) == invalid);
  CHECK(unisim_get_trajectory(host, &pose, 1, nullptr) == invalid);
  CHECK(unisim_get_covariance(host, 0, nullptr) == invalid);
  CHECK(unisim_get_covariance(host, 99, covariance) == invalid);
  CHECK(unisim_get_submap(host, 0, &submap_info) == invalid);
  CHECK(unisim_get_submap(host, 0, nullptr) == invalid);
  CHECK(unisim_get_info(host, nullptr) == invalid);
  check_untouched(*this, UNISIM_OK, UNISIM_OK);
}

TEST_CASE_METHOD(Fixture, "time stamps must grow") {
  unisim_keyframe keyframe = {};
  keyframe.struct_size = sizeof keyframe;
  int32_t id = -7;
  keyframe.timestamp_ns = GENERATE(10000, 9999, -1);
  CHECK(unisim_add_keyframe(host, &keyframe, &id) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(id == -7);
  check_untouched(*this, UNISIM_OK, UNISIM_OK);
}

TEST_CASE("configurations out of range are refused") {
  unisim_config config = default_config();
  size_t size = 1;
  SECTION("preset") { config.preset = 2; }
  SECTION("window of one") { config.window_size = 1; }
  SECTION("window too large") { config.window_size = UNISIM_MAX_VIEWS + 1; }
  SECTION("overlap as large as the window") { config.window_overlap = config.window_size; }
  SECTION("negative overlap") { config.window_overlap = -1; }
  SECTION("one keyframe") { config.max_keyframes = 1; }
  SECTION("too many keyframes") { config.max_keyframes = 65537; }
  SECTION("negative submaps") { config.max_submaps = -1; }
  SECTION("negative loops") { config.max_loops = -1; }
  SECTION("grid too small") { config.depth_grid_width = 3; }
  SECTION("grid too large") { config.depth_grid_height = 513; }
  SECTION("unknown factor bit") { config.disabled_factors = 32; }
  SECTION("negative weight") { config.weight_tie = -0.1; }
  SECTION("NaN weight") { config.weight_bridge = kNan; }
  SECTION("zero huber_delta") { config.huber_delta = 0.0; }
  SECTION("NaN loop_delta") { config.loop_delta = kNan; }
  SECTION("exponent above 1") { config.live_scale_exponent = 1.5; }
  SECTION("confidence_drop") { config.confidence_drop = 0.95; }
  SECTION("sigma_reference") { config.sigma_reference = 0.0; }
  SECTION("sigma_gate") { config.sigma_gate = -1.0; }
  SECTION("sigma_gate_loop") { config.sigma_gate_loop = kNan; }
  SECTION("sigma_factor") { config.sigma_factor = -1.0; }
  SECTION("scatter_gate") { config.scatter_gate = 0.0; }
  SECTION("lost_after") { config.lost_after = 0; }
  SECTION("max_iterations") { config.max_iterations = 0; }
  CHECK(unisim_arena_size(&config, &size) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(size == 1);
}
