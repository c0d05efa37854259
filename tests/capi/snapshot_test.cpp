// SPDX-License-Identifier: MIT
// A map that outlives the run: loaded, it goes on as if it had not been interrupted.
#include <algorithm>
#include <cstring>
#include <utility>

#include "tests/capi/world.hpp"
#include "tests/support/same_session.hpp"
#include "tests/support/snapshot_bytes.hpp"

using namespace unisim::test;

namespace {

unisim_config small_config(int32_t window_submaps) {
  unisim_config config = small_windows(window_submaps);
  config.skeleton_capacity = 8;
  config.max_keyframes = 250;
  return config;
}

/// A host with what the other has saved.
struct Copy {
  Copy(const Host& of, const unisim_config& config) : host(config) {
    SnapshotBytes snapshot = save(of);
    REQUIRE(load(host, &snapshot) == UNISIM_OK);
    CHECK(snapshot.read == snapshot.bytes.size());
    host.go_on(of.info().keyframes);
  }
  Host host;
};

bool same_poses(const Host& a, const Host& b) {
  const int32_t keyframes = a.info().keyframes;
  return keyframes == b.info().keyframes && same_poses(a, b, keyframes);
}

void check_same(const Host& a, const Host& b) {
  CHECK(same_poses(a, b));
  CHECK(same_info(a, b));
}

int32_t loop_state(const Host& host, int32_t id) {
  unisim_loop_info info = {};
  info.struct_size = sizeof info;
  REQUIRE(unisim_get_loop(host, id, &info) == UNISIM_OK);
  return info.state;
}

}  // namespace

TEST_CASE("a saved map goes on in another session with the same bits") {
  const int32_t window_submaps = GENERATE(0, 2);
  const int32_t at = GENERATE(1, 5, 21, 60, 150);
  CAPTURE(window_submaps, at);
  const unisim_config config = small_config(window_submaps);
  World world(220, 3U, kNoise);
  Host host(config);
  feed(host, world, at);
  World again = world;
  Copy copy(host, config);
  check_same(host, copy.host);
  feed(host, world, 60);
  feed(copy.host, again, 60);
  check_same(host, copy.host);
}

TEST_CASE("a covariance can be asked for before and after the map was loaded") {
  const unisim_config config = small_config(2);
  World world(120, 3U, kNoise);
  Host host(config);
  feed(host, world, 100);
  double ours[49];
  double theirs[49];
  {
    Copy changed(host, config);
    CHECK(unisim_get_covariance(changed.host, 95, theirs) == UNISIM_ERR_NOT_READY);
  }
  host.optimize();
  Copy copy(host, config);
  REQUIRE(unisim_get_covariance(host, 95, ours) == UNISIM_OK);
  REQUIRE(unisim_get_covariance(copy.host, 95, theirs) == UNISIM_OK);
  CHECK(std::memcmp(ours, theirs, sizeof ours) == 0);
}

TEST_CASE("saving leaves the map as it is") {
  const unisim_config config = small_config(2);
  World world(120, 3U, kNoise);
  Host host(config);
  feed(host, world, 100);
  const SnapshotBytes before = save(host);
  CHECK(save(host).bytes == before.bytes);
  SnapshotBytes full;
  full.limit = before.bytes.size() / 2;
  CHECK(unisim_save_map(host, SnapshotBytes::write, &full) == UNISIM_ERR_IO);
  CHECK(save(host).bytes == before.bytes);
}

TEST_CASE("a map that was saved differs from one that was not in its last digits only") {
  const unisim_config config = small_config(2);
  World world(160, 3U, kNoise);
  World again = world;
  Host host(config);
  Host never_saved(config);
  feed(host, world, 80);
  feed(never_saved, again, 80);
  save(host);
  feed(host, world, 60);
  feed(never_saved, again, 60);
  double largest = 0.0;
  for (int32_t id = 0; id < 140; ++id) {
    const unisim::Sim3 apart =
        between(from_c(host.pose(id).T_world_kf), from_c(never_saved.pose(id).T_world_kf));
    largest = std::max(largest, sim3_log(apart).cwiseAbs().maxCoeff());
  }
  CHECK(largest < 1e-6);
}

TEST_CASE("a loop over the break joins what came after it to the map") {
  const int32_t window_submaps = GENERATE(0, 2);
  const unisim_config config = small_config(window_submaps);
  World world(200, 3U, kNoise);
  Host host(config);
  feed(host, world, 100);
  Copy copy(host, config);
  Host& next = copy.host;
  // Another run: its clock starts anew, and what was open is not answered any more.
  CHECK(next.add_keyframe_at(5) == 100);
  CHECK(next.reject_pair() == UNISIM_OK);
  for (int32_t id = 101; id < 130; ++id) {
    CHECK(next.add_keyframe_at(id) == id);
    REQUIRE(next.add_pair(world.pair(id - 1)) == UNISIM_OK);
    const unisim_request request = next.next(UNISIM_REQUEST_WINDOW);
    if (request.kind != 0) REQUIRE(unisim_reject_request(next, &request) == UNISIM_OK);
  }
  CHECK(next.pose(129).segment == 1);
  CHECK(next.info().segments == 2);
  REQUIRE(next.add_loop(world.views(both(30, 120))) >= 0);
  next.optimize();
  CHECK(next.info().segments == 1);
  CHECK(next.pose(129).segment == 0);
  CHECK(next.pose(129).state == UNISIM_STATE_TRACKING);
  CHECK(next.info().state == UNISIM_STATE_RELOCALISED);
  CHECK(worst_position_error(next, world, 100) < 0.3);
}

TEST_CASE("a pair over the break goes on in the segment of the map") {
  const int32_t window_submaps = GENERATE(0, 2);
  const unisim_config config = small_config(window_submaps);
  World world(200, 3U, kNoise);
  Host host(config);
  feed(host, world, 100);
  Copy copy(host, config);
  Host& next = copy.host;
  for (int32_t id = 100; id < 103; ++id) {
    CHECK(next.add_keyframe_at(id) == id);
    if (id < 102) CHECK(next.reject_pair() == UNISIM_OK);
  }
  REQUIRE(next.add_pair(world.pair(99, 102)) == UNISIM_OK);
  CHECK(next.info().state == UNISIM_STATE_RELOCALISED);
  CHECK(next.pose(102).segment == 0);
  for (int32_t id = 103; id < 120; ++id) {
    CHECK(next.add_keyframe_at(id) == id);
    REQUIRE(next.add_pair(world.pair(id - 1)) == UNISIM_OK);
    const unisim_request request = next.next(UNISIM_REQUEST_WINDOW);
    if (request.kind == 0) continue;
    REQUIRE(next.add_submap(world.views(ids(request.keyframe_ids[0], request.count))) >= 0);
    next.optimize();
  }
  CHECK(next.info().segments == 1);
  CHECK(worst_position_error(next, world, 120) < 0.3);
}

TEST_CASE("a map in two segments goes on, and is joined, with the same bits") {
  const int32_t window_submaps = GENERATE(0, 2);
  const unisim_config config = small_config(window_submaps);
  World world(200, 3U, kNoise);
  Host host(config);
  feed(host, world, 60);
  for (int32_t k = 0; k < 12; ++k) {
    host.add_keyframe();
    REQUIRE(host.reject_pair() == UNISIM_OK);
    const unisim_request request = host.next(UNISIM_REQUEST_WINDOW);
    if (request.kind != 0) REQUIRE(unisim_reject_request(host, &request) == UNISIM_OK);
  }
  feed(host, world, 60);
  REQUIRE(host.info().segments == 2);
  World again = world;
  Copy copy(host, config);
  CHECK(same_poses(host, copy.host));
  for (auto [session, truth] : {std::pair<Host*, World*>{&host, &world}, {&copy.host, &again}}) {
    REQUIRE(session->add_loop(truth->views(both(30, 110))) >= 0);
    session->optimize();
    feed(*session, *truth, 40);
  }
  CHECK(host.info().segments == 1);
  check_same(host, copy.host);
}

TEST_CASE("within a run time goes on") {
  const unisim_config config = small_config(2);
  World world(40, 3U, kNoise);
  Host host(config);
  feed(host, world, 20);
  Copy copy(host, config);
  unisim_keyframe keyframe = {};
  keyframe.struct_size = sizeof keyframe;
  keyframe.timestamp_ns = 7;
  int32_t id = -1;
  CHECK(unisim_add_keyframe(copy.host, &keyframe, &id) == UNISIM_OK);
  CHECK(id == 20);
  CHECK(unisim_add_keyframe(copy.host, &keyframe, &id) == UNISIM_ERR_INVALID_ARGUMENT);
}

TEST_CASE("loops go on as they were: live, condensed, suspended, removed") {
  const unisim_config config = small_config(2);
  World world(220, 3U, kNoise);
  Host host(config);
  feed(host, world, 90);
  const int32_t condensed = host.add_loop(world.views(both(10, 70)));
  feed(host, world, 60);
  const int32_t live = host.add_loop(world.views(both(30, 140)));
  const int32_t removed = host.add_loop(world.views(both(50, 142)));
  Views wrong = world.views(both(20, 144));
  for (size_t k = 4; k < 8; ++k) wrong.T_submap_kf[k].t[0] += 4.0;
  const int32_t suspended = host.add_loop(wrong);
  for (int k = 0; k < 6; ++k) host.optimize(3);
  REQUIRE(unisim_remove_loop(host, removed) == UNISIM_OK);
  REQUIRE(loop_state(host, suspended) == UNISIM_LOOP_SUSPENDED);
  World again = world;
  Copy copy(host, config);
  for (const int32_t loop : {condensed, live, removed, suspended}) {
    CHECK(loop_state(copy.host, loop) == loop_state(host, loop));
  }
  CHECK(copy.host.info().suspended_loops == 1);
  feed(host, world, 60);
  feed(copy.host, again, 60);
  check_same(host, copy.host);
}

TEST_CASE("only a session without keyframes takes a map") {
  const unisim_config config = small_config(2);
  World world(40, 3U, kNoise);
  Host host(config);
  feed(host, world, 20);
  SnapshotBytes snapshot = save(host);
  CHECK(load(host, &snapshot) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(host.info().keyframes == 20);
  REQUIRE(unisim_session_reset(host) == UNISIM_OK);
  CHECK(load(host, &snapshot) == UNISIM_OK);
  CHECK(host.info().keyframes == 20);
}

TEST_CASE("a session that is too small or another one says which number") {
  World world(120, 3U, kNoise);
  Host host(small_config(2));
  feed(host, world, 100);
  SnapshotBytes snapshot = save(host);
  const auto refused = [&](const unisim_config& config) {
    Host other(config);
    CHECK(load(other, &snapshot) == UNISIM_ERR_CAPACITY);
    CHECK(other.info().keyframes == 0);
    return load_report(other);
  };
  unisim_config config = small_config(2);
  config.skeleton_capacity = 4 + 4;
  config.max_keyframes = 90;
  unisim_load_report report = refused(config);
  CHECK(report.problem == UNISIM_LOAD_CAPACITY);
  CHECK(std::string(report.section) == "keyframe");
  CHECK(std::string(report.setting) == "max_keyframes");
  CHECK(report.needed == 100);
  CHECK(report.given == 90);
  config = small_config(2);
  config.preset = UNISIM_PRESET_PAPER;
  report = refused(config);
  CHECK(report.problem == UNISIM_LOAD_SETTING);
  CHECK(std::string(report.setting) == "preset");
  config = small_config(0);
  report = refused(config);
  CHECK(report.problem == UNISIM_LOAD_SETTING);
  CHECK(std::string(report.setting) == "window_submaps");
  CHECK(report.needed == 2);
  CHECK(report.given == 0);
  struct Case {
    const char* setting;
    int32_t unisim_config::* field;
    int32_t value;
    int64_t needed;
    int32_t problem;
  };
  for (const Case& c : {
           Case{"window_size", &unisim_config::window_size, 6, 8, UNISIM_LOAD_CAPACITY},
           Case{"window_overlap", &unisim_config::window_overlap, 1, 2, UNISIM_LOAD_CAPACITY},
           Case{"depth_grid_width", &unisim_config::depth_grid_width, 40, 80, UNISIM_LOAD_SETTING},
           Case{"depth_grid_height", &unisim_config::depth_grid_height, 90, 60,
                UNISIM_LOAD_SETTING},
       }) {
    config = small_config(2);
    config.*c.field = c.value;
    report = refused(config);
    CHECK(std::string(report.setting) == c.setting);
    CHECK(report.needed == c.needed);
    CHECK(report.given == c.value);
    CHECK(report.problem == c.problem);
  }
}

TEST_CASE("a session with fewer windows, skeleton nodes or loops than the map has says so") {
  World world(200, 3U, kNoise);
  unisim_config config = small_config(3);
  config.skeleton_capacity = 12;
  Host host(config);
  feed(host, world, 180);
  for (int32_t k = 0; k < 5; ++k) REQUIRE(host.add_loop(world.views(both(20 + k, 170))) >= 0);
  SnapshotBytes snapshot = save(host);
  const auto setting_of = [&](const unisim_config& smaller, int64_t needed) {
    Host other(smaller);
    CHECK(load(other, &snapshot) == UNISIM_ERR_CAPACITY);
    CHECK(load_report(other).problem == UNISIM_LOAD_CAPACITY);
    CHECK(load_report(other).needed == needed);
    return std::string(load_report(other).setting);
  };
  unisim_config smaller = config;
  smaller.window_submaps = 2;
  CHECK(setting_of(smaller, 3) == "window_submaps");
  smaller = config;
  smaller.skeleton_capacity = 8;
  CHECK(setting_of(smaller, 12) == "skeleton_capacity");
  smaller = config;
  smaller.max_loops = 2;
  CHECK(setting_of(smaller, 3) == "max_loops");
}

TEST_CASE("a larger session takes the map") {
  World world(200, 3U, kNoise);
  Host host(small_config(2));
  feed(host, world, 100);
  unisim_config config = small_config(3);
  config.max_keyframes = 400;
  config.max_loops = 100;
  config.window_size = 10;
  config.skeleton_capacity = 20;
  Copy copy(host, config);
  CHECK(same_poses(host, copy.host));
  feed(copy.host, world, 100);
  CHECK(copy.host.info().keyframes == 200);
}

TEST_CASE("arguments of saving and loading") {
  Host host(small_config(2));
  SnapshotBytes bytes;
  CHECK(unisim_save_map(nullptr, SnapshotBytes::write, &bytes) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_save_map(host, nullptr, &bytes) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_load_map(nullptr, SnapshotBytes::take, &bytes) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_load_map(host, nullptr, &bytes) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_get_load_report(host, nullptr) == UNISIM_ERR_INVALID_ARGUMENT);
  unisim_load_report report = {};
  CHECK(unisim_get_load_report(host, &report) == UNISIM_ERR_ABI_MISMATCH);
  CHECK(load_report(host).problem == UNISIM_LOAD_OK);
}

TEST_CASE("a map without keyframes is a map") {
  Host host(small_config(2));
  Copy copy(host, small_config(2));
  CHECK(same_info(host, copy.host));
}
