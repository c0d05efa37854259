// SPDX-License-Identifier: MIT
// Depth, colour and pose of two rendered views agree with each other.
#include <algorithm>

#include "tests/support/catch.hpp"
#include "tools/synth/path.hpp"
#include "tools/synth/renderer.hpp"

namespace {

using namespace unisim::synth;

struct View {
  Eigen::Isometry3d T_world_cam;
  ColorImage colors;
  DepthImage depth;
};

View view_at(const Renderer& renderer, const Camera& camera, const Eigen::Isometry3d& pose) {
  const auto pixels = static_cast<size_t>(camera.width) * static_cast<size_t>(camera.height);
  View view{pose, ColorImage(pixels, Color::Zero()), DepthImage(pixels, 0)};
  renderer.render([&](int) { return pose; }, &view.colors, &view.depth);
  return view;
}

struct Agreement {
  int seen = 0;               ///< points of the first view that fall into the second
  int same_depth = 0;         ///< of these, at the depth the second view has there
  double color_median = 0;    ///< grey levels, over those of the same depth
  double depth_quantile = 0;  ///< 80 % of relative depth differences
};

/// Carries each pixel of `first` to the nearest pixel of `second`. Distortion-free camera.
Agreement compare(const Camera& camera, const View& first, const View& second) {
  const Eigen::Isometry3d T_second_first = second.T_world_cam.inverse() * first.T_world_cam;
  Agreement result;
  std::vector<double> colors;
  std::vector<double> depths;
  for (int row = 0; row < camera.height; ++row) {
    for (int column = 0; column < camera.width; ++column) {
      const auto at = static_cast<size_t>(row * camera.width + column);
      const Eigen::Vector3d ray = camera.ray(column, row).cast<double>().homogeneous();
      const Eigen::Vector3d point = T_second_first * (ray * first.depth[at]);
      const double u = camera.focal_px * point.x() / point.z() + camera.center_x();
      const double v = camera.focal_px * point.y() / point.z() + camera.center_y();
      if (point.z() < 0.1 || u < 0 || v < 0 || u > camera.width - 1 || v > camera.height - 1) {
        continue;
      }
      ++result.seen;
      const auto there = static_cast<size_t>(std::lround(v) * camera.width + std::lround(u));
      const double difference = std::abs(point.z() / second.depth[there] - 1);
      depths.push_back(difference);
      if (difference < 0.01) {
        ++result.same_depth;
        colors.push_back((first.colors[at] - second.colors[there]).cwiseAbs().mean());
      }
    }
  }
  const auto quantile = [](std::vector<double>* values, double share) {
    const auto nth =
        values->begin() + static_cast<ptrdiff_t>(share * static_cast<double>(values->size() - 1));
    std::nth_element(values->begin(), nth, values->end());
    return *nth;
  };
  if (!colors.empty()) {
    result.color_median = quantile(&colors, 0.5);
    result.depth_quantile = quantile(&depths, 0.8);
  }
  return result;
}

}  // namespace

TEST_CASE("depth and pose carry the pixels of one view to the same colours in another") {
  const auto kind = GENERATE(SceneKind::kRoom, SceneKind::kCorridor, SceneKind::kDesk);
  const Camera camera{320, 240, 262, 0};
  const Scene scene = make_scene(kind, 3);
  const Renderer renderer(scene, camera, false);
  const CameraPath path({kind, 10, 1, 3});
  const View first = view_at(renderer, camera, path.T_world_cam(4.0));
  const View second = view_at(renderer, camera, path.T_world_cam(4.2));
  const Agreement agreement = compare(camera, first, second);
  const int pixels = camera.width * camera.height;
  CHECK(agreement.seen > pixels / 2);
  CHECK(agreement.same_depth > 0.8 * agreement.seen);
  CHECK(agreement.depth_quantile < 0.01);
  CHECK(agreement.color_median < 6);
}

TEST_CASE("a wrong pose does not") {
  const Camera camera{320, 240, 262, 0};
  const Scene scene = make_room(3);
  const Renderer renderer(scene, camera, false);
  const CameraPath path({SceneKind::kRoom, 10, 1, 3});
  const View first = view_at(renderer, camera, path.T_world_cam(4.0));
  View second = view_at(renderer, camera, path.T_world_cam(4.2));
  second.T_world_cam.translate(Eigen::Vector3d(0.1, 0, 0));
  const Agreement agreement = compare(camera, first, second);
  CHECK(agreement.color_median > 6);
}

TEST_CASE("depth is the distance along the optical axis") {
  Scene scene(0.01);
  scene.add_face({-5, 2, 5}, Eigen::Vector3d::UnitX(), -Eigen::Vector3d::UnitZ(), 10, 10,
                 [](Canvas* canvas) { canvas->paint_rect(canvas->area(), Color(100, 100, 100)); });
  const Camera camera{64, 48, 50, 0};
  const Renderer renderer(scene, camera, false);
  Eigen::Isometry3d T_world_cam = Eigen::Isometry3d::Identity();
  T_world_cam.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;  // looks along +y, z is up
  const View view = view_at(renderer, camera, T_world_cam);
  const auto extremes = std::minmax_element(view.depth.begin(), view.depth.end());
  CHECK(*extremes.first == Approx(2).epsilon(1e-6));
  CHECK(*extremes.second == Approx(2).epsilon(1e-6));
}

TEST_CASE("a distorted pixel looks where the pinhole's pixel at the undistorted place looks") {
  const Camera pinhole{640, 480, 500, 0};
  const Camera distorted{640, 480, 500, -0.1};
  const Eigen::Vector2f ray = distorted.ray(119.5, 239.5);  // 200 px left of the centre: r = 0.4
  const double undistorted = 200 * (1 - 0.1 * 0.4 * 0.4);
  CHECK(ray.x() == Approx(pinhole.ray(319.5 - undistorted, 239.5).x()));
  CHECK(ray.y() == Approx(0).margin(1e-7));
}

TEST_CASE("under a rolling shutter each row is that of the view from its own pose") {
  const Camera camera{96, 64, 80, 0};
  const Scene scene = make_room(3);
  const CameraPath path({SceneKind::kRoom, 10, 1, 3});
  const auto pose_of_row = [&](int row) { return path.T_world_cam(4.0 + 0.001 * row); };
  const auto pixels = static_cast<size_t>(camera.width * camera.height);
  ColorImage rolled(pixels, Color::Zero());
  Renderer(scene, camera, true).render(pose_of_row, &rolled, nullptr);
  const Renderer global(scene, camera, false);
  for (const int row : {0, 20, 63}) {
    const View whole = view_at(global, camera, pose_of_row(row));
    for (int column = 0; column < camera.width; ++column) {
      const auto at = static_cast<size_t>(row * camera.width + column);
      CHECK((rolled[at] - whole.colors[at]).norm() == Approx(0).margin(1e-3));
    }
  }
}
