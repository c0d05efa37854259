// SPDX-License-Identifier: MIT
// The true cloud of a recording: where depth images and their camera are found, where points lie.
#include "tools/eval/truth_cloud.hpp"

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "tests/support/catch.hpp"
#include "tests/support/program_in_folder.hpp"
#include "tests/support/temp_folder.hpp"

using namespace unisim::eval;

namespace {

constexpr int kWidth = 64;
constexpr int kHeight = 48;

/// A wall 2 m ahead of the first camera, farther at the right; units a metre.
cv::Mat1w wall(double units, double nearer = 0.0) {
  cv::Mat1w depth(kHeight, kWidth);
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u)
      depth(v, u) = static_cast<uint16_t>((2.0 + 0.01 * u - nearer) * units);
  }
  depth(0, 0) = 0;
  depth(0, 1) = 65535;
  return depth;
}

void write_image(const TempFolder& folder, const std::string& name, const cv::Mat& image) {
  folder.make_parent(name);
  REQUIRE(cv::imwrite(folder / name, image));
}

/// Three frames, the camera going ahead, to the side and up by 0.1 m.
void write_tum(const TempFolder& folder) {
  folder.write("rgb.txt", "1.0 rgb/a.png\n1.1 rgb/b.png\n1.2 rgb/c.png\n");
  folder.write("depth.txt",
               "# depth\n1.0 depth/a.png\n1.1 depth/b.png\n1.2 depth/gone.png\n1.9 depth/c.png\n");
  folder.write("groundtruth.txt",
               "1.0 0 0 0 0 0 0 1\n1.1 0.1 0 0.1 0 0 0 1\n1.2 0.2 0.1 0 0 0 0 1\n");
  folder.write("camera.toml", "[camera]\nfx = 50\nfy = 40\ncx = 31.5\ncy = 23.5\nk1 = 0\n");
  write_image(folder, "depth/a.png", wall(5000.0));
  write_image(folder, "depth/b.png", wall(5000.0, 0.1));
  write_image(folder, "depth/c.png", wall(5000.0));
  write_image(folder, "rgb/a.png", cv::Mat1b(kHeight, kWidth, uint8_t{90}));
}

void write_scenes(const TempFolder& folder) {
  for (const std::string name : {"frame-000000", "frame-000001", "frame-000002"}) {
    write_image(folder, name + ".color.png", cv::Mat1b(kHeight, kWidth, uint8_t{90}));
    write_image(folder, name + ".depth.png", wall(1000.0));
    folder.write(name + ".pose.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  }
}

TruthOptions all_pixels() {
  TruthOptions options;
  options.pixel_step = 1;
  options.voxel = 1e-6;
  return options;
}

}  // namespace

TEST_CASE("a point of the truth lies where its pixel and its pose put it") {
  const TempFolder folder;
  write_tum(folder);
  const DepthImages found = find_depth_images({folder.path(), "auto", "", {}, 0.0});
  REQUIRE(found.format == "tum");
  REQUIRE(found.images.size() == 4);
  TruthOptions options = all_pixels();
  options.last_s = 1.05;
  const TruthCloud truth = make_truth(found, options);
  REQUIRE(truth.images == 1);
  REQUIRE(truth.cloud.points.size() == size_t{kWidth} * kHeight - 2);
  // Pixel (2, 0) is the first with a depth: 2.02 m.
  const Eigen::Vector3d expected((2 - 31.5) / 50 * 2.02, (0 - 23.5) / 40 * 2.02, 2.02);
  REQUIRE((truth.cloud.points.front() - expected).norm() < 1e-9);
}

TEST_CASE("views of one wall are one wall, thinned to a point a cube") {
  const TempFolder folder;
  write_tum(folder);
  const DepthImages found = find_depth_images({folder.path(), "tum", "", {}, 0.0});
  TruthOptions options = all_pixels();
  options.voxel = 0.1;
  const TruthCloud truth = make_truth(found, options);
  REQUIRE(truth.images == 2);
  REQUIRE(truth.unposed == 1);  // the one at 1.9 s
  REQUIRE(truth.unreadable == 1);
  REQUIRE(truth.cloud.points.size() < 1500);
  for (const Eigen::Vector3d& point : truth.cloud.points) {
    REQUIRE(point.z() > 1.99);
    REQUIRE(point.z() < 2.65);
  }
}

TEST_CASE("pixels beyond the limit are left out") {
  const TempFolder folder;
  write_tum(folder);
  TruthOptions options = all_pixels();
  options.max_depth = 2.3;
  options.every = 3;
  const TruthCloud truth =
      make_truth(find_depth_images({folder.path(), "auto", "", {}, 0.0}), options);
  REQUIRE(truth.images == 1);
  for (const Eigen::Vector3d& point : truth.cloud.points) REQUIRE(point.z() <= 2.3);
}

TEST_CASE("7-Scenes: millimetres, its usual camera or the one of the file beside it") {
  const TempFolder folder;
  write_scenes(folder);
  DepthImages found = find_depth_images({folder.path(), "auto", "", {}, 0.0});
  REQUIRE(found.units_per_metre == 1000.0);
  REQUIRE(found.camera.fx == 585.0);
  REQUIRE(found.notes.size() == 1);
  folder.write("intrinsics.K.txt", "615.2 0 298.4\n0 615.3 247.5\n0 0 1\n");
  found = find_depth_images({folder.path(), "auto", "", {}, 0.0});
  REQUIRE(found.camera.fx == 615.2);
  REQUIRE(found.camera.fy == 615.3);
  REQUIRE(found.camera.cx == 298.4);
  REQUIRE(found.camera.cy == 247.5);
  REQUIRE(make_truth(found, all_pixels()).images == 3);
}

TEST_CASE("Replica: depth beside the colour images, its camera one folder up") {
  const TempFolder folder;
  folder.write("cam_params.json",
               R"({"camera": {"w": 64, "h": 48, "fx": 60, "fy": 60, "cx": 31.5, "cy": 23.5,)"
               R"( "scale": 6000}})");
  write_image(folder, "room0/results/frame000000.jpg", cv::Mat1b(kHeight, kWidth, uint8_t{90}));
  write_image(folder, "room0/results/depth000000.png", wall(6000.0));
  folder.write("room0/traj.txt", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n");
  const DepthImages found = find_depth_images({folder / "room0", "auto", "", {}, 0.0});
  REQUIRE(found.units_per_metre == 6000.0);
  const TruthCloud truth = make_truth(found, all_pixels());
  REQUIRE(truth.cloud.points.front().z() == Approx(2.02).margin(1e-3));
}

TEST_CASE("what is missing is named") {
  const TempFolder folder;
  write_tum(folder);
  std::filesystem::remove(folder / "camera.toml");
  const DepthRequest request{folder.path(), "auto", "", {}, 0.0};
  REQUIRE_THROWS_WITH(find_depth_images(request), Catch::Contains("--intrinsics"));
  folder.write("camera.toml", "fx = x\n");
  REQUIRE_THROWS_WITH(find_depth_images(request), Catch::Contains("camera.toml"));
  std::filesystem::remove(folder / "groundtruth.txt");
  REQUIRE_THROWS_WITH(find_depth_images(request), Catch::Contains("--ground-truth"));
  std::filesystem::remove(folder / "depth.txt");
  REQUIRE_THROWS_WITH(find_depth_images(request), Catch::Contains("no depth.txt"));
}

TEST_CASE("cloud against a recording: moved as the poses align, protocol told, truth kept") {
  ProgramInFolder program(UNISIM_EVAL_PROGRAM);
  const TempFolder& folder = program.folder();
  write_tum(folder);
  REQUIRE(program.run("cloud . nothing.ply --write-truth gt.ply --voxel 0.05") == 3);
  Cloud estimate = read_ply(folder / "gt.ply");
  for (Eigen::Vector3d& point : estimate.points) point *= 0.5;
  REQUIRE(write_ply(folder / "half.ply", estimate));
  folder.write("half.tum", "1.0 0 0 0 0 0 0 1\n1.1 0.05 0 0.05 0 0 0 1\n1.2 0.1 0.05 0 0 0 0 1\n");
  REQUIRE(program.run("cloud . half.ply --trajectory half.tum --voxel 0.05 --json") == 0);
  const auto json = nlohmann::json::parse(program.out);
  // Thinned a second time, a few of the means fall on the other side of a border.
  CHECK(json["chamfer"].get<double>() < 0.002);
  CHECK(json["protocol"]["truth"]["depth_images"] == 2);
  CHECK(json["protocol"]["truth"]["intrinsics"][1] == 40.0);
  CHECK(json["protocol"]["voxel"] == 0.05);
  CHECK(json["protocol"]["T_truth_estimate"]["scale"].get<double>() == Approx(2.0));
  program.require_failure("cloud . half.ply --trajectories half.tum half.tum", 2, "--trajectory");
  program.require_failure("cloud gt.ply half.ply --trajectory half.tum", 2, "--trajectories");
  program.require_failure("cloud . half.ply --format euroc", 3, "mav0");
  program.require_failure("cloud . half.ply --write-truth /nowhere/gt.ply", 4, "gt.ply");
}
