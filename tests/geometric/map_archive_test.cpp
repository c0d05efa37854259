// SPDX-License-Identifier: MIT
// A map that outlives its run: what is saved is what is loaded, and nothing else is.
#include <algorithm>
#include <string>

#include "tests/geometric/map_bytes.hpp"
#include "tests/geometric/predictor_run.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"

namespace unisim::geometric::test {

namespace {

unisim_geometric_config camera_config() {
  unisim_geometric_config config = default_config();
  config.focal_px = kFocal;
  return config;
}

/// So small that damage can be tried byte by byte.
unisim_geometric_config small_config() {
  unisim_geometric_config config = camera_config();
  config.max_tracks = 50;
  config.revive_tries = 30;
  config.max_landmarks = 200;
  config.max_keyframes = 32;
  return config;
}

std::string message(PredictorRun* run) { return run->table()->message(run->table()); }

/// The map of the first 60 steps of the walk: 20 keyframes.
MapBytes walked_map(const unisim_geometric_config& config) {
  PredictorRun run(config);
  show_walk(&run, 0, 60);
  REQUIRE(run.table()->finish(run.table()) == UNISIM_PREDICTION_OK);
  return save(run.table());
}

}  // namespace

TEST_CASE("a later run finds itself in a saved map and goes on with it") {
  const MapBytes map = walked_map(camera_config());
  PredictorRun run(camera_config());
  run.go_on_with(load(run.table(), map));
  CHECK(run.keyframes() == 20);
  show_walk(&run, 60, 90);
  CHECK(run.info().relocalised == 1);
  CHECK(run.info().restarts == 0);
  REQUIRE(run.pair(19) == UNISIM_PREDICTION_OK);
  CHECK(run.last_pair().gap == 0);
  std::vector<CameraPlace> truth;
  for (int step = 0; step < 90; step += kStride) truth.push_back(walk(step));
  CHECK(relative_error(run.window(0, 30), truth) < 0.02);
}

TEST_CASE("a map that was loaded is saved as the same bytes") {
  const MapBytes map = walked_map(camera_config());
  PredictorRun run(camera_config());
  load(run.table(), map);
  CHECK(save(run.table()) == map);
}

TEST_CASE("a map with room to grow keeps its landmarks where they are") {
  unisim_geometric_config larger = camera_config();
  larger.max_landmarks += 1000;
  larger.max_keyframes += 20;
  const MapBytes map = walked_map(camera_config());
  PredictorRun run(larger);
  run.go_on_with(load(run.table(), map));
  CHECK(save(run.table()) == map);
  show_walk(&run, 60, 66);
  CHECK(run.info().relocalised == 1);
}

TEST_CASE("a map of another place begins a segment of its own after the usual time") {
  PredictorRun run(camera_config());
  run.go_on_with(load(run.table(), walked_map(camera_config())));
  for (int step = 0; step < 90; ++step) {
    CameraPlace place = walk(step);
    // The room behind its back.
    const Eigen::Matrix3d about = Eigen::AngleAxisd(3.1, Eigen::Vector3d::UnitY()).matrix();
    place.R = about * place.R;
    place.center = about * place.center;
    run.show(render_room(place), step % kStride == 0);
  }
  CHECK(run.info().relocalised == 0);
  CHECK(run.info().restarts == 1);
  CHECK(run.pair(19) == UNISIM_PREDICTION_REJECTED);
  CHECK(run.pair(run.keyframes() - 2) == UNISIM_PREDICTION_OK);
}

TEST_CASE("frames are found in a frozen map, which stays as it is") {
  const MapBytes map = walked_map(camera_config());
  PredictorRun run(camera_config());
  load(run.table(), map);
  std::vector<CameraPlace> truth;
  std::vector<unisim_sim3> found;
  // In no order: nothing can be followed.
  for (const int step : {31, 4, 49, 10, 40, 22, 55, 16}) {
    unisim_location location{};
    REQUIRE(locate(run.table(), render_room(walk(step)), &location) == UNISIM_PREDICTION_OK);
    CHECK(location.inliers >= 20);
    CHECK(location.in_view >= location.inliers);
    CHECK(location.keyframe_id < 20);
    truth.push_back(walk(step));
    found.push_back(location.T_map_frame);
  }
  CHECK(relative_error(found, truth) < 0.02);
  CHECK(save(run.table()) == map);
}

TEST_CASE("a frame is looked for where the last one was, and anew when it is not there") {
  PredictorRun run(camera_config());
  load(run.table(), walked_map(camera_config()));
  unisim_location location{};
  for (int step = 20; step < 30; ++step) {
    REQUIRE(locate(run.table(), render_room(walk(step)), &location) == UNISIM_PREDICTION_OK);
    CHECK(location.followed == (step == 20 ? 0 : 1));
  }
  const GrayImage black(static_cast<size_t>(kWidth) * kHeight, 0);
  CHECK(locate(run.table(), black, &location) == UNISIM_PREDICTION_REJECTED);
  REQUIRE(locate(run.table(), render_room(walk(50)), &location) == UNISIM_PREDICTION_OK);
  CHECK(location.followed == 0);
}

TEST_CASE("another place is not found in a map") {
  PredictorRun run(camera_config());
  load(run.table(), walked_map(camera_config()));
  for (int step = 0; step < 60; step += 6) {
    CameraPlace place = walk(step);
    place.R = Eigen::AngleAxisd(3.1, Eigen::Vector3d::UnitY()).matrix() * place.R;
    unisim_location location{};
    CHECK(locate(run.table(), render_room(place), &location) == UNISIM_PREDICTION_REJECTED);
  }
}

TEST_CASE("the camera of a map is taken where none is given, and must be the same where one is") {
  const MapBytes map = walked_map(camera_config());
  unisim_geometric_config config = default_config();
  const double focal = GENERATE(0.0, kFocal, kFocal + 1);
  config.focal_px = focal;
  PredictorRun run(config);
  int32_t next = -1;
  const int status = try_load(run.table(), map, &next);
  if (focal > kFocal) {
    CHECK(status == UNISIM_PREDICTION_REJECTED);
    CHECK(has(message(&run), "focal length of 300.0"));
    return;
  }
  REQUIRE(status == UNISIM_PREDICTION_OK);
  CHECK(run.info().focal_px == kFocal);
}

TEST_CASE("images of another size are refused with both sizes") {
  PredictorRun run(camera_config());
  load(run.table(), walked_map(camera_config()));
  const GrayImage small(size_t{160} * 120, 0);
  unisim_frame frame{};
  frame.image = {small.data(), 160, 120, 160, UNISIM_PIXEL_GRAY8};
  unisim_motion motion{};
  unisim_location location{};
  CHECK(run.table()->locate(run.table(), &frame, &location) == UNISIM_PREDICTION_REJECTED);
  CHECK(run.table()->observe(run.table(), &frame, &motion) == UNISIM_PREDICTION_REJECTED);
  CHECK(has(message(&run), "320x240"));
  CHECK(has(message(&run), "160x120"));
}

TEST_CASE("what does not fit a smaller configuration says what to raise") {
  const MapBytes map = walked_map(camera_config());
  unisim_geometric_config config = camera_config();
  std::string raise;
  SECTION("landmarks") {
    config.max_landmarks = 200;
    config.max_tracks = 50;
    config.revive_tries = 30;
    raise = "max_landmarks";
  }
  SECTION("observations") {
    config.max_tracks = 50;
    config.revive_tries = 1;
    raise = "max_tracks";
  }
  PredictorRun run(config);
  int32_t next = -1;
  CHECK(try_load(run.table(), map, &next) == UNISIM_PREDICTION_REJECTED);
  CHECK(has(message(&run), raise));
  CHECK(next == -1);
}

TEST_CASE("there is nothing to save before there is a map") {
  PredictorRun run(camera_config());
  MapBytes bytes;
  CHECK(try_save(run.table(), &bytes) == UNISIM_PREDICTION_REJECTED);
  run.show(render_room(walk(0)), true);
  CHECK(try_save(run.table(), &bytes) == UNISIM_PREDICTION_REJECTED);
  CHECK(has(message(&run), "no map yet"));
}

TEST_CASE("a map is loaded before the first frame or not at all") {
  const MapBytes map = walked_map(camera_config());
  PredictorRun run(camera_config());
  run.show(render_room(walk(0)), true);
  int32_t next = -1;
  CHECK(try_load(run.table(), map, &next) == UNISIM_PREDICTION_REJECTED);
}

TEST_CASE("a writer that takes no more ends the saving") {
  PredictorRun run(small_config());
  show_walk(&run, 0, 60);
  MapBytes bytes;
  REQUIRE(try_save(run.table(), &bytes) == UNISIM_PREDICTION_OK);
  const size_t all = bytes.size();
  for (const size_t room : {size_t{0}, size_t{1}, size_t{1000}, all / 2, all - 1}) {
    CHECK(try_save(run.table(), &bytes, room) == UNISIM_PREDICTION_REJECTED);
    CHECK(has(message(&run), "could not be written"));
  }
}

TEST_CASE("a map that ends too early is refused by the name of the part, and leaves no trace") {
  const MapBytes map = walked_map(small_config());
  PredictorRun run(small_config());
  for (size_t size = 0; size < map.size(); size += size < 400 ? 1 : 1009) {
    const MapBytes cut(map.begin(), map.begin() + static_cast<std::ptrdiff_t>(size));
    int32_t next = -1;
    REQUIRE(try_load(run.table(), cut, &next) == UNISIM_PREDICTION_REJECTED);
    CHECK(has(message(&run), "ends too early"));
  }
  run.go_on_with(load(run.table(), map));
  show_walk(&run, 60, 66);
  CHECK(run.info().relocalised == 1);
}

TEST_CASE("no damage to a map does more than to have it refused") {
  const MapBytes map = walked_map(small_config());
  int refused = 0;
  for (size_t at = 0; at < map.size(); at += at < 200 ? 1 : 1511) {
    MapBytes bad = map;
    bad[at] = static_cast<uint8_t>(bad[at] ^ (at % 3 == 0 ? 0x80 : 0xff));
    INFO("byte " << at);
    PredictorRun run(small_config());
    int32_t next = -1;
    if (try_load(run.table(), bad, &next) != UNISIM_PREDICTION_OK) {
      ++refused;
      continue;
    }
    // A wrong number that could be right: the map may be bad, the run goes on.
    if (next > 1000000) continue;
    run.go_on_with(next);
    // Its images may have another size.
    if (run.show(render_room(walk(56)), false) == UNISIM_PREDICTION_OK) show_walk(&run, 57, 61);
    MapBytes again;
    CHECK(try_save(run.table(), &again) == UNISIM_PREDICTION_OK);
  }
  CHECK(refused > 50);
}

TEST_CASE("maps of other versions say so") {
  MapBytes map = walked_map(small_config());
  for (const auto& [version, named] : {std::pair(9, "version 9"), std::pair(1, "version 1")}) {
    map[0] = static_cast<MapBytes::value_type>(version);
    PredictorRun run(small_config());
    int32_t next = -1;
    REQUIRE(try_load(run.table(), map, &next) == UNISIM_PREDICTION_REJECTED);
    CHECK(has(message(&run), named));
  }
}

}  // namespace unisim::geometric::test
