// SPDX-License-Identifier: MIT
// What the geometric predictor makes of a camera that moves.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "tests/geometric/predictor_run.hpp"
#include "tests/support/catch.hpp"

namespace unisim::geometric::test {
namespace {

// Shows the walk, 60 images of which each third is a keyframe, after `change` has been at them.
// @return where the keyframes are
template <class Change>
std::vector<CameraPlace> show_changed(PredictorRun* run, Change change) {
  std::vector<CameraPlace> places;
  for (int step = 0; step < 60; ++step) {
    GrayImage image = render_room(walk(step));
    change(step, &image);
    REQUIRE(run->show(image, step % 3 == 0) == UNISIM_PREDICTION_OK);
    if (step % 3 == 0) places.push_back(walk(step));
  }
  return places;
}

}  // namespace

TEST_CASE("a moving camera is posed from its images alone") {
  PredictorRun run(default_config());
  run.show_path(walk, 90, 3);
  REQUIRE(run.table()->finish(run.table()) == UNISIM_PREDICTION_OK);
  const std::vector<unisim_sim3> poses = run.window(0, run.keyframes());
  REQUIRE(poses.size() == run.places().size());
  CHECK(relative_error(poses, run.places()) < 0.03);
  CHECK(run.info().initialised == 1);
  CHECK(run.info().restarts == 0);
  CHECK(run.info().focal_px == Approx(kFocal).epsilon(0.04));
}

TEST_CASE("a known focal length is kept and serves the poses") {
  unisim_geometric_config config = default_config();
  config.focal_px = kFocal;
  PredictorRun run(config);
  run.show_path(walk, 60, 3);
  CHECK(run.info().focal_px == kFocal);
  CHECK(std::abs(run.info().radial_k1) < 0.01);
  CHECK(relative_error(run.window(0, run.keyframes()), run.places()) < 0.01);
}

// The room through a camera whose principal point lies off the middle: its image, shifted.
TEST_CASE("a principal point off the middle is found") {
  constexpr int kRight = 4;
  constexpr int kUp = 3;
  PredictorRun run(default_config());
  for (int step = 0; step < 120; ++step) {
    const GrayImage centered = render_room(walk(step));
    GrayImage image(centered.size());
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const int from_x = std::clamp(x - kRight, 0, kWidth - 1);
        const int from_y = std::clamp(y + kUp, 0, kHeight - 1);
        image[static_cast<size_t>(y * kWidth + x)] =
            centered[static_cast<size_t>(from_y * kWidth + from_x)];
      }
    }
    REQUIRE(run.show(image, step % 3 == 0) == UNISIM_PREDICTION_OK);
  }
  REQUIRE(run.table()->finish(run.table()) == UNISIM_PREDICTION_OK);
  CHECK(run.info().center_x_px == Approx(kRight).margin(2.0));
  CHECK(run.info().center_y_px == Approx(-kUp).margin(2.0));
}

TEST_CASE("pairs wait for the start and then give relative poses and depth in one unit") {
  PredictorRun run(default_config());
  run.show_path(walk, 4, 3);
  CHECK(run.pair(0) == UNISIM_PREDICTION_PENDING);
  run.show_path(walk, 60, 3);
  const int last = run.keyframes() - 2;
  REQUIRE(run.pair(last) == UNISIM_PREDICTION_OK);
  const unisim_pair_prediction& pair = run.last_pair();
  CHECK(pair.T_i_j.s == 1.0);
  CHECK(pair.center_sigma > 0.0);
  int measured = 0;
  for (int cell = 0; cell < pair.depth_j.width * pair.depth_j.height; ++cell) {
    const float depth = pair.depth_j.depth[cell];
    CHECK(std::isfinite(depth));
    measured += depth > 0.0F && pair.depth_j.confidence[cell] == 1.0F ? 1 : 0;
  }
  CHECK(measured > 50);
}

TEST_CASE("exposure jumps do not disturb tracking") {
  unisim_geometric_config config = default_config();
  config.focal_px = kFocal;
  PredictorRun run(config);
  const std::vector<CameraPlace> places = show_changed(&run, [](int step, GrayImage* image) {
    const int offset = step % 20 >= 10 ? 30 : 0;
    for (std::uint8_t& gray : *image) gray = static_cast<std::uint8_t>(gray / 2 + offset);
  });
  CHECK(run.info().restarts == 0);
  CHECK(relative_error(run.window(0, run.keyframes()), places) < 0.02);
}

TEST_CASE("images of few grey levels are posed") {
  PredictorRun run(default_config());
  const std::vector<CameraPlace> places = show_changed(&run, [](int, GrayImage* image) {
    for (std::uint8_t& gray : *image) gray = static_cast<std::uint8_t>(100 + gray / 20);
  });
  REQUIRE(run.info().initialised == 1);
  CHECK(run.info().restarts == 0);
  CHECK(relative_error(run.window(0, run.keyframes()), places) < 0.1);
}

TEST_CASE("contrast that changes from frame to frame does not disturb tracking") {
  unisim_geometric_config config = default_config();
  config.focal_px = kFocal;
  PredictorRun run(config);
  const std::vector<CameraPlace> places = show_changed(&run, [](int step, GrayImage* image) {
    for (std::uint8_t& gray : *image) {
      gray = static_cast<std::uint8_t>(step % 2 == 0 ? gray / 2 : gray / 4);
    }
  });
  REQUIRE(run.info().initialised == 1);
  CHECK(run.info().restarts == 0);
  CHECK(relative_error(run.window(0, run.keyframes()), places) < 0.05);
}

TEST_CASE("the same images give the same bytes, with and without the background thread") {
  std::vector<unisim_sim3> first;
  for (const int background : {1, 0, 1}) {
    unisim_geometric_config config = default_config();
    config.background = background;
    config.adjust_every = 5;
    PredictorRun run(config);
    run.show_path(walk, 90, 3);
    run.table()->finish(run.table());
    const std::vector<unisim_sim3> poses = run.window(0, run.keyframes());
    REQUIRE(poses.size() == run.places().size());
    if (first.empty()) first = poses;
    CHECK(std::memcmp(first.data(), poses.data(), poses.size() * sizeof(unisim_sim3)) == 0);
  }
}

TEST_CASE("memory is set by the configuration, not by the length of the run") {
  unisim_geometric_config config = default_config();
  config.max_keyframes = 32;
  PredictorRun run(config);
  run.show_path(walk, 60, 3);
  const int64_t early = run.info().state_bytes;
  run.show_path(walk, 90, 1);
  CHECK(run.keyframes() > 2 * config.max_keyframes);
  CHECK(run.info().state_bytes == early);
  CHECK(early > 0);
  CHECK(early < int64_t{60} << 20);
  int32_t pairs = 0;
  for (int32_t i = 0; i + 1 < run.keyframes(); ++i) pairs += run.pair(i) == UNISIM_PREDICTION_OK;
  CHECK(pairs < config.max_keyframes);
  CHECK(pairs >= config.max_keyframes / 2 - 1);
  CHECK(run.pair(run.keyframes() - 2) == UNISIM_PREDICTION_OK);
}

TEST_CASE("a window given out early is measured again when the state has improved") {
  unisim_geometric_config config = default_config();
  config.adjust_every = 5;
  PredictorRun run(config);
  run.show_path(walk, 48, 3);
  const int32_t ids[] = {4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  unisim_window_prediction window{};
  REQUIRE(run.table()->multi_view(run.table(), ids, 12, &window) == UNISIM_PREDICTION_OK);
  CHECK(window.center_sigma > 0.0);
  for (int step = 48; step < 90; ++step) run.show(render_room(walk(step)), step % 3 == 0);
  run.table()->finish(run.table());
  unisim_window_revision revision{};
  REQUIRE(run.table()->next_revision(run.table(), &revision) == UNISIM_PREDICTION_OK);
  CHECK(revision.token == window.token);
  REQUIRE(revision.count == 12);
  for (int i = 0; i < 12; ++i) CHECK(std::isfinite(revision.log_depth_ratio[i]));
  CHECK(run.table()->next_revision(run.table(), &revision) == UNISIM_PREDICTION_PENDING);
}

}  // namespace unisim::geometric::test
