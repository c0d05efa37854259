// SPDX-License-Identifier: MIT
// A camera that zooms while it films is told; one that goes ahead is not taken for one.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "tests/geometric/predictor_run.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"

namespace unisim::geometric::test {
namespace {

constexpr int kZoomFrames = 75;
constexpr int kZoomStride = 3;
constexpr int kZoomBegin = 45;

/// Straight ahead through the room, which makes all of it grow.
CameraPlace ahead(int step) {
  CameraPlace place;
  place.center = Eigen::Vector3d(0.2, 0.1, -2.5 + 0.04 * step);
  return place;
}

/// Remark of the window over all keyframes of a path whose zoom takes `frames` frames to `factor`.
std::string remark(CameraPlace (*path)(int), double factor, int frames) {
  PredictorRun run(default_config());
  int keyframes = 0;
  for (int step = 0; step < kZoomFrames; ++step) {
    const double done = std::clamp((step - kZoomBegin + 1.0) / frames, 0.0, 1.0);
    const bool keyframe = step % kZoomStride == 0;
    keyframes += keyframe ? 1 : 0;
    run.show(render_room(path(step), kFocal * std::pow(factor, done)), keyframe);
  }
  std::vector<int32_t> ids(static_cast<std::size_t>(keyframes));
  std::iota(ids.begin(), ids.end(), 0);
  unisim_window_prediction window{};
  REQUIRE(run.table()->multi_view(run.table(), ids.data(), keyframes, &window) ==
          UNISIM_PREDICTION_OK);
  return window.remark != nullptr ? window.remark : "";
}

}  // namespace

TEST_CASE("a zoom in is told with the frame near which it began") {
  const std::string told = remark(walk, 1.3, 12);
  INFO(told);
  CHECK(has(told, "zoomed near frame 4"));
}

TEST_CASE("a zoom out is told") {
  CHECK(has(remark(walk, 1 / 1.3, 12), "the camera seems to have zoomed near frame 4"));
}

TEST_CASE("a zoom from one frame to the next is told") {
  CHECK(has(remark(walk, 1.5, 1), "zoomed near frame 45:"));
}

TEST_CASE("a camera that walks or goes straight ahead has not zoomed") {
  CHECK(remark(walk, 1.0, 1).empty());
  CHECK(remark(ahead, 1.0, 1).empty());
}

}  // namespace unisim::geometric::test
