// SPDX-License-Identifier: MIT
// The ground under the cameras of a window: found where there is one, refused with the reason else.
#include "drivers/pipeline/ground_plane.hpp"

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"

using unisim::pipeline::find_ground;
using unisim::pipeline::GroundPlane;

namespace {

constexpr int kWidth = 80;
constexpr int kHeight = 60;
constexpr double kFocal = 400.0;
constexpr int32_t kImageWidth = 640;
constexpr int32_t kImageHeight = 480;

/// Depth along the ray of a pixel of a camera that looks along a corridor, < 0: nothing there.
/// @param x, y at depth 1, y down
using Scene = std::function<double(double x, double y)>;

/// Views of a camera that drives ahead, pitched down.
struct Window {
  explicit Window(const Scene& scene, double pitch = 0.0, double rise = 0.0, double noise = 0.02) {
    std::mt19937 random(5);
    std::normal_distribution<double> normal(0.0, noise);
    depth.resize(8);
    for (int view = 0; view < 8; ++view) {
      ids.push_back(view);
      const double c = std::cos(0.5 * pitch);
      const double s = -std::sin(0.5 * pitch);  // about x: the optical axis turns down
      poses.push_back({{s, 0.0, 0.0, c}, {0.0, -rise * view, 0.2 * view}, 1.0});
      std::vector<float>& map = depth[static_cast<size_t>(view)];
      for (int row = 0; row < kHeight; ++row) {
        for (int column = 0; column < kWidth; ++column) {
          const double x = ((column + 0.5) / kWidth - 0.5) * kImageWidth / kFocal;
          const double y = ((row + 0.5) / kHeight - 0.5) * kImageHeight / kFocal;
          // The ray in the frame of the ground: z ahead.
          const double down = y * std::cos(pitch) + std::sin(pitch);
          const double ahead = -y * std::sin(pitch) + std::cos(pitch);
          const double scaled = scene(x / ahead, down / ahead) / ahead;
          map.push_back(static_cast<float>(scaled * (1.0 + normal(random))));
        }
      }
      maps.push_back({map.data(), nullptr, kWidth, kHeight});
    }
    window.count = 8;
    window.keyframe_ids = ids.data();
    window.T_window_kf = poses.data();
    window.depth = maps.data();
    window.focal_px = kFocal;
  }
  std::vector<int32_t> ids;
  std::vector<unisim_sim3> poses;
  std::vector<std::vector<float>> depth;
  std::vector<unisim_depth_map> maps;
  unisim_window_prediction window{};
};

GroundPlane ground_of(const Window& window) {
  return find_ground(window.window, kImageWidth, kImageHeight);
}

/// A corridor of this half width with a floor so far below the camera and a wall at its end.
Scene corridor(double half_width, double floor, double end) {
  return [=](double x, double y) {
    double z = end;
    if (y > 0.0) z = std::min(z, floor / y);
    if (std::abs(x) > 1e-9) z = std::min(z, half_width / std::abs(x));
    return z;
  };
}

}  // namespace

TEST_CASE("the height over a floor is found, level or pitched") {
  const double pitch = GENERATE(0.0, 0.2, 0.4);
  CAPTURE(pitch);
  const GroundPlane ground = ground_of(Window(corridor(2.0, 1.3, 12.0), pitch));
  INFO(ground.reason);
  REQUIRE(ground.height > 0.0);
  CHECK(ground.height == Approx(1.3).epsilon(0.03));
  CHECK(ground.sigma >= 0.02);
  CHECK(ground.sigma < 0.05);
  CHECK(ground.points > 200);
}

TEST_CASE("the same window gives the same ground") {
  const Window window(corridor(2.0, 1.3, 12.0), 0.1);
  CHECK(ground_of(window).height == ground_of(window).height);
}

TEST_CASE("where there is no ground none is found, and why is told") {
  // A wall ahead and nothing else.
  const GroundPlane wall = ground_of(Window([](double, double) { return 3.0; }));
  CHECK(wall.height == 0.0);
  CHECK(has(wall.reason, "plane"));
  // A table in front, the floor beyond its edge.
  const GroundPlane table = ground_of(Window([](double, double y) {
    const double on_table = y > 0.0 ? 0.4 / y : 100.0;
    return on_table < 1.3 ? on_table : y > 0.0 ? std::min(1.6 / y, 12.0) : 12.0;
  }));
  CHECK(table.height != Approx(0.4).epsilon(0.1));
  // It climbs: the floor is not level with the way.
  const GroundPlane climbs = ground_of(Window(corridor(2.0, 1.3, 12.0), 0.0, 0.15));
  CHECK(climbs.height == 0.0);
  CHECK_FALSE(std::string(climbs.reason).empty());
}

TEST_CASE("a window without focal length or depth says so") {
  Window window(corridor(2.0, 1.3, 12.0));
  window.window.focal_px = 0.0;
  CHECK(has(ground_of(window).reason, "focal length"));
  window.window.focal_px = kFocal;
  for (unisim_depth_map& map : window.maps) map.width = map.height = 0;
  CHECK(has(ground_of(window).reason, "no depth"));
}
