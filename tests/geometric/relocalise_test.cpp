// SPDX-License-Identifier: MIT
// A camera that is covered for a while, and what becomes of its track.
#include <cmath>

#include "tests/geometric/predictor_run.hpp"
#include "tests/support/catch.hpp"

namespace unisim::geometric::test {

namespace {

GrayImage black() { return GrayImage(static_cast<size_t>(kWidth) * kHeight, 0); }

void show_black(PredictorRun* run, int frames) {
  for (int k = 0; k < frames; ++k) run->show(black(), k % kStride == 0);
}

}  // namespace

TEST_CASE("a camera that was covered is found again in the map") {
  unisim_geometric_config config = default_config();
  config.focal_px = kFocal;
  config.places = GENERATE(0, 1);
  PredictorRun run(config);
  show_walk(&run, 0, 60);
  const int before = run.keyframes();
  show_black(&run, 30);
  const int after = run.keyframes();
  show_walk(&run, 60, 90);
  CHECK(run.info().relocalised == config.places);
  // The pair that ends at the first keyframe in the light.
  if (config.places == 0) {
    CHECK(run.pair(after - 1) != UNISIM_PREDICTION_OK);
    return;
  }
  REQUIRE(run.pair(after - 1) == UNISIM_PREDICTION_OK);
  CHECK(run.last_pair().gap == after - before);
  for (int dark = before - 1; dark < after - 1; ++dark) {
    CHECK(run.pair(dark) == UNISIM_PREDICTION_REJECTED);
  }
  CHECK(run.pair(after) == UNISIM_PREDICTION_OK);
  CHECK(run.last_pair().gap == 0);
  std::vector<CameraPlace> truth;
  for (int step = 0; step < 90; step += kStride) truth.push_back(walk(step));
  CHECK(relative_error(run.window(0, run.keyframes()), truth) < 0.02);
}

TEST_CASE("a camera that comes back elsewhere begins a segment of its own") {
  unisim_geometric_config config = default_config();
  config.focal_px = kFocal;
  PredictorRun run(config);
  show_walk(&run, 0, 60);
  show_black(&run, 30);
  for (int step = 0; step < 60; ++step) {
    CameraPlace place = walk(step);
    // The room behind its back.
    const Eigen::Matrix3d about = Eigen::AngleAxisd(3.1, Eigen::Vector3d::UnitY()).matrix();
    place.R = about * place.R;
    place.center = about * place.center;
    run.show(render_room(place), step % kStride == 0);
  }
  CHECK(run.info().relocalised == 0);
  CHECK(run.info().restarts > 0);
  REQUIRE(run.info().place_count > 0);
  for (int k = 0; k < run.info().place_count; ++k) CHECK(run.info().places[k].accepted == 0);
}

}  // namespace unisim::geometric::test
