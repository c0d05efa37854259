// SPDX-License-Identifier: MIT
// Our logs and messages to the Python module lcm, and back.
#include <vector>

#include "tests/lcm/child.hpp"
#include "tests/lcm/event_log.hpp"
#include "tests/lcm/image_log.hpp"
#include "tests/lcm/publisher_fixture.hpp"
#include "tests/lcm/python_lcm.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::testing;

namespace {

/// A message of each channel, two images.
void publish_each(unisim_lcm_publisher* out) {
  const unisim_sim3 T = some_pose();
  std::vector<unisim_pose> poses = {some_keyframe(0), some_keyframe(3)};
  double covariance[49] = {};
  for (int k = 0; k < 7; ++k) covariance[8 * k] = k + 0.5;
  unisim_lcm_correction correction{};
  correction.struct_size = sizeof correction;
  correction.map_revision = 4;
  correction.T_new_old = T;
  const unisim_lcm_stage stages[] = {{"decode", 5, 1.0, 2.0, 3.0}, {"optimize", 7, 1.5, 2.5, 3.5}};
  unisim_lcm_status status{};
  status.struct_size = sizeof status;
  status.state = UNISIM_STATE_TRACKING;
  status.stage_count = 2;
  status.stages = stages;
  const std::vector<float> xyz = {1.0f, 2.0f, 3.0f, -1.0f, 0.5f, 4.0f};
  unisim_lcm_points points{};
  points.struct_size = sizeof points;
  points.T_world_points = T;
  points.xyz = xyz.data();
  points.count = 2;
  const std::vector<uint8_t> pixels(48, 77);
  const unisim_image image = {pixels.data(), 8, 6, 8, UNISIM_PIXEL_GRAY8};
  REQUIRE(unisim_lcm_publish_pose(out, 123456789, &T) == UNISIM_LCM_QUEUED);
  REQUIRE(unisim_lcm_publish_keyframe(out, poses.data(), 1, covariance) == UNISIM_LCM_QUEUED);
  REQUIRE(unisim_lcm_publish_correction(out, &correction) == UNISIM_LCM_QUEUED);
  REQUIRE(unisim_lcm_publish_trajectory(out, 5000, 4, poses.data(), 2, 0, 1) == UNISIM_LCM_QUEUED);
  REQUIRE(unisim_lcm_publish_status(out, &status) == UNISIM_LCM_QUEUED);
  REQUIRE(unisim_lcm_publish_points(out, &points) == UNISIM_LCM_QUEUED);
  REQUIRE(unisim_lcm_publish_image(out, 1000000, &image) == UNISIM_LCM_QUEUED);
  REQUIRE(unisim_lcm_publish_image(out, 2000000, &image) == UNISIM_LCM_QUEUED);
}

}  // namespace

TEST_CASE("Python reads our log, encodes the same bytes, and its log is read here") {
  const TempFolder folder;
  UNISIM_SKIP_WITHOUT_PYTHON_LCM(folder.path());
  LoggedPublisher out;
  publish_each(out.get());
  const std::string ours = out.close();
  const std::string theirs = folder / "python.lcm";
  Child copy({python(), UNISIM_LCM_COPY_LOG, ours, theirs});
  CHECK(copy.line() ==
        "UNISIM_CORRECTION 1 UNISIM_IMAGE 2 UNISIM_KEYFRAME 1 UNISIM_POINTS 1 UNISIM_POSE 1 "
        "UNISIM_STATUS 1 UNISIM_TRAJECTORY 1");
  REQUIRE(copy.end() == 0);
  const std::vector<LogEvent> sent = read_log(ours);
  const std::vector<LogEvent> copied = read_log(theirs);
  REQUIRE(sent.size() == 8);
  REQUIRE(copied.size() == sent.size());
  for (size_t k = 0; k < sent.size(); ++k) {
    INFO(sent[k].channel);
    CHECK(copied[k].channel == sent[k].channel);
    CHECK(copied[k].data == sent[k].data);
  }
  const Played played = play_log(theirs);
  CHECK(played.failure.empty());
  CHECK(played.first_bytes == std::vector<int>{77, 77});
  CHECK(played.times_ns == std::vector<int64_t>{1000000, 2000000});
}
