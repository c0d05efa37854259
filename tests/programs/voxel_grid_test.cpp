// SPDX-License-Identifier: MIT
// Points thinned to one per cube.
#include "tools/common/voxel_grid.hpp"

#include <random>

#include "tests/support/catch.hpp"

using unisim::tools::VoxelGrid;
using unisim::tools::VoxelPoint;

TEST_CASE("points of one cube become their weighted mean") {
  VoxelGrid grid(1.0, 100);
  grid.add({0.2, 0.2, 0.2}, {0, 100, 255}, 0.3, 1.0);
  grid.add({-0.2, 0.2, 0.2}, {10, 10, 10}, 0.5, 1.0);
  grid.add({0.6, 0.6, 0.6}, {100, 100, 55}, 0.9, 3.0);
  REQUIRE(grid.size() == 2);  // cubes end at whole numbers, below zero too
  const VoxelPoint point = grid.point(0);
  REQUIRE(point.position[0] == Approx(0.5));
  REQUIRE(point.colour[0] == Approx(75.0));
  REQUIRE(point.colour[2] == Approx(105.0));
  REQUIRE(point.confidence == 0.9);
  REQUIRE(point.count == 2);
}

TEST_CASE("with more cubes than fit the cubes grow, and no point is lost") {
  std::mt19937 generator(5);
  VoxelGrid grid(0.01, 64);
  std::array<double, 3> sum{};
  for (int k = 0; k < 5000; ++k) {
    std::array<double, 3> p{};
    for (size_t i = 0; i < 3; ++i) {
      p[i] = static_cast<double>(generator() % 20000) / 1e4 - 1.0;
      sum[i] += p[i];
    }
    grid.add(p, {}, 0.0, 1.0);
    REQUIRE(grid.size() <= 64);
  }
  REQUIRE(grid.side() > 0.2);
  int64_t count = 0;
  for (size_t k = 0; k < grid.size(); ++k) {
    const VoxelPoint point = grid.point(k);
    count += point.count;
    for (size_t i = 0; i < 3; ++i) sum[i] -= point.position[i] * static_cast<double>(point.count);
  }
  REQUIRE(count == 5000);
  for (const double rest : sum) REQUIRE(rest == Approx(0.0).margin(1e-9));
}

TEST_CASE("cubes that grew hold what a grid of that side would") {
  VoxelGrid small(0.25, 8);
  VoxelGrid large(1.0, 1000);
  for (int k = 0; k < 40; ++k) {
    const std::array<double, 3> p = {0.1 * k - 2.03, 0.0, 0.0};
    small.add(p, {}, 0.0, 1.0);
    large.add(p, {}, 0.0, 1.0);
  }
  REQUIRE(small.side() == 1.0);
  REQUIRE(small.size() == large.size());
  for (size_t k = 0; k < small.size(); ++k)
    REQUIRE(small.point(k).position[0] == Approx(large.point(k).position[0]));
}
