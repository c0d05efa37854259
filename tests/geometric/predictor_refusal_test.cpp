// SPDX-License-Identifier: MIT
// What the geometric predictor says when the images do not tell a pose.
#include <cstring>
#include <string>

#include "tests/geometric/predictor_run.hpp"
#include "tests/support/catch.hpp"

namespace unisim::geometric::test {

namespace {
CameraPlace stand(int) { return walk(7); }
}  // namespace

TEST_CASE("a camera at rest never starts") {
  PredictorRun run(default_config());
  run.show_path(stand, 40, 2);
  CHECK(run.info().initialised == 0);
  CHECK(run.info().focal_px == 0.0);
  CHECK(run.info().static_frames > 30);
  CHECK(run.pair(0) == UNISIM_PREDICTION_PENDING);
}

TEST_CASE("a turn on the spot is recognised and not taken for a movement") {
  PredictorRun run(default_config());
  run.show_path(turn, 60, 3);
  CHECK(run.info().initialised == 0);
  CHECK(run.info().rotation_only > 0);
}

TEST_CASE("blind frames are refused and a new segment begins after them without places") {
  unisim_geometric_config config = default_config();
  config.places = 0;
  PredictorRun run(config);
  run.show_path(walk, 60, 3);
  REQUIRE(run.pair(run.keyframes() - 2) == UNISIM_PREDICTION_OK);
  const GrayImage black(static_cast<std::size_t>(kWidth) * kHeight, 0);
  for (int i = 0; i < 4; ++i) run.show(black, true);
  CHECK(run.pair(run.keyframes() - 2) != UNISIM_PREDICTION_OK);
  CHECK(run.pair(run.keyframes() - 4) == UNISIM_PREDICTION_REJECTED);
  CHECK(std::strlen(run.table()->message(run.table())) > 0);
  run.show_path(walk, 60, 3);
  CHECK(run.info().restarts >= 1);
  CHECK(run.pair(run.keyframes() - 2) == UNISIM_PREDICTION_OK);
  const std::vector<unisim_sim3> poses = run.window(run.keyframes() - 16, 16);
  REQUIRE(poses.size() == 16);
  const std::vector<CameraPlace> places(run.places().end() - 16, run.places().end());
  CHECK(relative_error(poses, places) < 0.03);
}

TEST_CASE("an image of another size is left out with a message") {
  PredictorRun run(default_config());
  run.show_path(walk, 2, 1);
  const GrayImage small(static_cast<std::size_t>(160) * 120, 90);
  unisim_frame frame{};
  frame.image = {small.data(), 160, 120, 160, UNISIM_PIXEL_GRAY8};
  unisim_motion motion{};
  CHECK(run.table()->observe(run.table(), &frame, &motion) == UNISIM_PREDICTION_REJECTED);
  CHECK(std::string(run.table()->message(run.table())).find("160x120") != std::string::npos);
  frame.image.data = nullptr;
  CHECK(run.table()->observe(run.table(), &frame, &motion) == UNISIM_PREDICTION_REJECTED);
  CHECK(run.show(render_room(walk(2)), true) == UNISIM_PREDICTION_OK);
}

TEST_CASE("keyframes out of order end the run with a message") {
  PredictorRun run(default_config());
  run.show_path(walk, 1, 1);
  unisim_frame frame{};
  CHECK(run.table()->keyframe(run.table(), &frame, 5) == UNISIM_PREDICTION_FAILED);
  CHECK(std::strlen(run.table()->message(run.table())) > 0);
}

TEST_CASE("a configuration out of range is refused with the field's name") {
  char message[256] = "";
  unisim_geometric_config config = default_config();
  config.max_keyframes = 3;
  CHECK(unisim_geometric_create(&config, message, sizeof message) == nullptr);
  CHECK(std::string(message).find("max_keyframes") != std::string::npos);
  config = default_config();
  config.focal_px = -1;
  CHECK(unisim_geometric_create(&config, message, sizeof message) == nullptr);
  CHECK(std::string(message).find("focal_px") != std::string::npos);
  config = default_config();
  config.struct_size = 8;
  CHECK(unisim_geometric_create(&config, nullptr, 0) == nullptr);
}

}  // namespace unisim::geometric::test
