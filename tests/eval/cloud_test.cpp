// SPDX-License-Identifier: MIT
// Clouds: PLY in its encodings, distances worked out by hand and by brute force.
#include <algorithm>
#include <cstring>
#include <random>

#include "tests/support/catch.hpp"
#include "tests/support/temp_folder.hpp"
#include "tools/eval/cloud_metrics.hpp"
#include "tools/eval/trajectory.hpp"

using namespace unisim::eval;

namespace {

template <typename T>
void append(std::string* bytes, T value, bool big_endian) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  if (big_endian) std::reverse(raw, raw + sizeof value);
  bytes->append(raw, sizeof value);
}

// Two vertices with a colour before the coordinates and a face after them.
std::string binary_ply(bool big_endian) {
  std::string bytes = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                      "_endian 1.0\ncomment made by a test\nelement vertex 2\nproperty uchar red\n"
                      "property double x\nproperty float y\nproperty float z\nelement face 1\n"
                      "property list uchar int vertex_indices\nend_header\n";
  for (int k = 0; k < 2; ++k) {
    append(&bytes, static_cast<uint8_t>(200), big_endian);
    append(&bytes, 1.5 + k, big_endian);
    append(&bytes, 2.5F, big_endian);
    append(&bytes, -3.5F, big_endian);
  }
  return bytes + std::string(13, '\1');
}

Cloud cloud_of(std::vector<Eigen::Vector3d> points) { return {"made", std::move(points), 0}; }

double brute_force_rmse(const Cloud& from, const Cloud& to) {
  double sum = 0;
  for (const Eigen::Vector3d& p : from.points) {
    double nearest = 1e300;
    for (const Eigen::Vector3d& q : to.points) nearest = std::min(nearest, (p - q).squaredNorm());
    sum += nearest;
  }
  return std::sqrt(sum / static_cast<double>(from.points.size()));
}

Cloud random_cloud(unsigned seed, size_t count) {
  std::mt19937 generator(seed);
  const auto next = [&] { return static_cast<double>(generator() % 100000) / 1e4; };
  Cloud cloud = cloud_of({});
  for (size_t k = 0; k < count; ++k) {
    const double x = next(), y = next();
    cloud.points.emplace_back(1000 + x, y, next());
  }
  return cloud;
}

}  // namespace

TEST_CASE("ascii PLY: any order of properties, points that are not finite counted") {
  const TempFolder folder;
  const Cloud cloud =
      read_ply(folder.write("a.ply",
                            "ply\r\nformat ascii 1.0\r\nelement vertex 3\r\nproperty float z\r\n"
                            "property float y\r\nproperty float x\r\nproperty uchar red\r\n"
                            "end_header\r\n3 2 1 255\r\nnan 0 0 0\r\n6 5 4 0\r\n"));
  REQUIRE(cloud.points.size() == 2);
  REQUIRE(cloud.skipped == 1);
  REQUIRE(cloud.points[0] == Eigen::Vector3d(1, 2, 3));
  REQUIRE(cloud.points[1] == Eigen::Vector3d(4, 5, 6));
}

TEST_CASE("binary PLY in both byte orders") {
  const TempFolder folder;
  const Cloud cloud = read_ply(folder.write("b.ply", binary_ply(GENERATE(false, true))));
  REQUIRE(cloud.points.size() == 2);
  REQUIRE(cloud.points[1] == Eigen::Vector3d(2.5, 2.5, -3.5));
}

TEST_CASE("PLY files of no use are refused") {
  const TempFolder folder;
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n";
  const std::string whole = binary_ply(false);
  const std::string in_vertices = whole.substr(0, whole.size() - 20);
  REQUIRE_THROWS_AS(read_ply(folder / "missing.ply"), InputError);
  REQUIRE_THROWS_AS(read_ply(folder.write("a.ply", "obj\n")), InputError);
  REQUIRE_THROWS_AS(read_ply(folder.write("b.ply", header + "end_header\n1 2\n3 4\n")), InputError);
  REQUIRE_THROWS_AS(read_ply(folder.write("c.ply", header + "property float z\n")), InputError);
  REQUIRE_THROWS_AS(
      read_ply(folder.write("d.ply", header + "property float z\nend_header\n1 2 3\n")),
      InputError);
  REQUIRE_THROWS_AS(read_ply(folder.write("e.ply", in_vertices)), InputError);
}

TEST_CASE("a count that a PLY file cannot hold is refused by its value") {
  const TempFolder folder;
  const std::string count =
      GENERATE("-1", "-1e30", "1e30", "inf", "nan", "1.5", "2147483648", "99999999999999999999");
  const std::string path = folder.write(
      "a.ply", "ply\nformat ascii 1.0\nelement vertex " + count +
                   "\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n");
  try {
    read_ply(path);
    FAIL(count + " vertices were read");
  } catch (const InputError& error) {
    REQUIRE(std::string(error.what()).find("'" + count + "'") != std::string::npos);
  }
}

TEST_CASE("a large count with few bytes behind it costs no memory") {
  const TempFolder folder;
  const std::string header =
      "element vertex 2147483647\nproperty float x\nproperty float y\nproperty float "
      "z\nend_header\n";
  for (const std::string encoding : {"ascii", "binary_little_endian"}) {
    const std::string path =
        folder.write("a.ply", "ply\nformat " + encoding + " 1.0\n" + header + "0 0 0\n0 0 0\n");
    REQUIRE_THROWS_WITH(read_ply(path), Catch::Contains("of 2147483647"));
  }
}

TEST_CASE("points farther than the search can tell apart are left out and counted") {
  const TempFolder folder;
  const Cloud cloud = read_ply(
      folder.write("a.ply",
                   "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double "
                   "y\nproperty double z\nend_header\n0 0 0\n1e300 0 0\n0 -1e30 0\n"));
  REQUIRE(cloud.points.size() == 1);
  REQUIRE(cloud.skipped == 2);
  Similarity huge;
  huge.s = 1e30;
  const Cloud ones = cloud_of({{1, 1, 1}});
  REQUIRE_THROWS_AS(compare_clouds(ones, ones, huge, 0), InputError);
}

TEST_CASE("accuracy, completeness and Chamfer by hand") {
  // The estimate hits one true point, misses another by 3 and has one 4 off.
  const Cloud truth = cloud_of({{0, 0, 0}, {10, 0, 0}, {10, 3, 0}});
  const Cloud estimate = cloud_of({{0, 0, 0}, {10, 0, 0}, {0, 4, 0}});
  const CloudMetrics metrics = compare_clouds(truth, estimate, {}, 0);
  REQUIRE(metrics.accuracy.rmse == Approx(4 / std::sqrt(3.0)));
  REQUIRE(metrics.accuracy.mean == Approx(4.0 / 3));
  REQUIRE(metrics.completeness.rmse == Approx(3 / std::sqrt(3.0)));
  REQUIRE(metrics.chamfer == Approx(3.5 / std::sqrt(3.0)));
  REQUIRE(metrics.beyond == 0);
  const CloudMetrics limited = compare_clouds(truth, estimate, {}, 3.5);
  REQUIRE(limited.accuracy.max == 3.5);
  REQUIRE(limited.beyond == 1);
}

TEST_CASE("the estimate is moved first") {
  const Cloud truth = cloud_of({{1, 0, 0}, {3, 0, 0}, {1, 2, 0}});
  const Cloud estimate = cloud_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  Similarity T_truth_estimate;
  T_truth_estimate.s = 2;
  T_truth_estimate.t = {1, 0, 0};
  REQUIRE(compare_clouds(truth, estimate, T_truth_estimate, 0).chamfer == Approx(0).margin(1e-12));
}

TEST_CASE("nearest neighbours are exact") {
  const Cloud truth = random_cloud(1, 900);
  const Cloud estimate = random_cloud(2, 700);
  const CloudMetrics metrics = compare_clouds(truth, estimate, {}, 0);
  REQUIRE(metrics.accuracy.rmse == Approx(brute_force_rmse(estimate, truth)).epsilon(1e-9));
  REQUIRE(metrics.completeness.rmse == Approx(brute_force_rmse(truth, estimate)).epsilon(1e-9));
}
