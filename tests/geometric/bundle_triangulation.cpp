// SPDX-License-Identifier: MIT
// Triangulation of one point from several posed views.
#include <limits>

#include "drivers/geometric/bundle/triangulation.hpp"
#include "tests/geometric/bundle_scene.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::geometric;

namespace {

std::vector<TriangulationView> views(const bundle_scene::Scene& scene,
                                     const Eigen::Vector3d& point) {
  std::vector<TriangulationView> list;
  for (const CameraPose& pose : scene.poses) {
    const Eigen::Vector3d y = pose.apply(point);
    list.push_back({&pose, y.head<2>() / y.z()});
  }
  return list;
}

TriangulationResult run(const std::vector<TriangulationView>& list) {
  return triangulate(list.data(), static_cast<int>(list.size()), TriangulationOptions());
}

}  // namespace

TEST_CASE("an exact point is triangulated exactly") {
  const bundle_scene::Scene scene = bundle_scene::make({});
  for (const Eigen::Vector3d& point : scene.points) {
    const TriangulationResult result = run(views(scene, point));
    REQUIRE(result.status == TriangulationStatus::kOk);
    REQUIRE((result.position - point).norm() < 1e-9);
  }
}

TEST_CASE("Gauss-Newton reaches the least reprojection error") {
  const bundle_scene::Scene scene = bundle_scene::make({});
  std::vector<TriangulationView> list = views(scene, Eigen::Vector3d(0.2, 0.1, 2.0));
  for (std::size_t i = 0; i < list.size(); ++i) {
    list[i].normalized += 1e-3 * Eigen::Vector2d(i % 2 == 0 ? 1.0 : -1.0, i % 3 == 0 ? 1.0 : -0.5);
  }
  const auto cost = [&list](const Eigen::Vector3d& x) {
    double sum = 0.0;
    for (const TriangulationView& view : list) {
      const Eigen::Vector3d y = view.pose->apply(x);
      sum += (y.head<2>() / y.z() - view.normalized).squaredNorm();
    }
    return sum;
  };
  const TriangulationResult result = run(list);
  REQUIRE(result.status == TriangulationStatus::kOk);
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = 1e-3 * Eigen::Vector3d::Unit(axis);
    REQUIRE(cost(result.position) < cost(result.position + step));
    REQUIRE(cost(result.position) < cost(result.position - step));
  }
}

TEST_CASE("parallax is the largest angle between two rays") {
  CameraPose left;
  CameraPose right;
  right.t.x() = -1.0;
  const TriangulationView pair[] = {{&left, Eigen::Vector2d(0.5, 0.0)},
                                    {&right, Eigen::Vector2d(-0.5, 0.0)},
                                    {&left, Eigen::Vector2d(0.5, 0.0)}};
  REQUIRE(parallax_angle(pair, 3) == Approx(2.0 * std::atan(0.5)));
}

TEST_CASE("too little parallax is refused") {
  const bundle_scene::Scene scene = bundle_scene::make({});
  const TriangulationResult result = run(views(scene, Eigen::Vector3d(0.0, 0.0, 500.0)));
  REQUIRE(result.status == TriangulationStatus::kLowParallax);
  REQUIRE(result.parallax_rad > 0.0);
}

TEST_CASE("rays that meet behind the cameras are refused") {
  CameraPose left;
  CameraPose right;
  right.t.x() = -1.0;
  const TriangulationView pair[] = {{&left, Eigen::Vector2d(-0.2, 0.0)},
                                    {&right, Eigen::Vector2d(0.2, 0.0)}};
  REQUIRE(triangulate(pair, 2, TriangulationOptions()).status == TriangulationStatus::kBehind);
}

TEST_CASE("a view that does not fit is refused") {
  const bundle_scene::Scene scene = bundle_scene::make({});
  std::vector<TriangulationView> list = views(scene, Eigen::Vector3d(0.2, 0.1, 2.0));
  list[5].normalized.y() += 0.05;
  const TriangulationResult result = run(list);
  REQUIRE(result.status == TriangulationStatus::kReprojection);
  REQUIRE(result.max_error > 0.01);
}

TEST_CASE("one view or a bad number gives no point") {
  const bundle_scene::Scene scene = bundle_scene::make({});
  std::vector<TriangulationView> list = views(scene, Eigen::Vector3d(0.2, 0.1, 2.0));
  REQUIRE(triangulate(list.data(), 1, TriangulationOptions()).status ==
          TriangulationStatus::kTooFewViews);
  list[3].normalized.x() = std::numeric_limits<double>::quiet_NaN();
  REQUIRE(run(list).status != TriangulationStatus::kOk);
}
