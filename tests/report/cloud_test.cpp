// SPDX-License-Identifier: MIT
// The fused cloud: where points lie, which are kept, whose depth counts.
#include "tools/replay/cloud.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/catch.hpp"
#include "tests/support/temp_folder.hpp"

using unisim::replay::Cloud;
using unisim::replay::CloudOptions;
using unisim::replay::RunData;

namespace {

constexpr int kWidth = 160;
constexpr int kHeight = 120;
constexpr double kFocal = 100.0;

struct Vertex {
  float x, y, z;
  uint8_t red, green, blue;
  float confidence;
};

/// Reads a cloud back. Checks the header on the way.
std::vector<Vertex> read_ply(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string line;
  size_t count = 0;
  while (std::getline(file, line) && line != "end_header") {
    if (line.rfind("element vertex ", 0) == 0) count = std::stoul(line.substr(15));
  }
  std::vector<Vertex> vertices(count);
  for (Vertex& v : vertices) {
    char raw[19];
    REQUIRE(file.read(raw, sizeof raw));
    std::memcpy(&v.x, raw, 12);
    std::memcpy(&v.red, raw + 12, 3);
    std::memcpy(&v.confidence, raw + 15, 4);
  }
  CHECK(file.peek() == std::ifstream::traits_type::eof());
  return vertices;
}

/// Left half red, right half blue.
struct Picture {
  std::vector<uint8_t> pixels = std::vector<uint8_t>(size_t{3} * kWidth * kHeight);
  unisim_frame frame{};
  Picture() {
    for (size_t k = 0; k < size_t{kWidth} * kHeight; ++k) {
      const bool left = k % kWidth < kWidth / 2;
      pixels[3 * k + (left ? 2 : 0)] = 200;
    }
    frame.image = {pixels.data(), kWidth, kHeight, 3 * kWidth, UNISIM_PIXEL_BGR8};
  }
};

constexpr int kColumns = 4;
constexpr int kRows = 3;

/// A window of one keyframe on a 4x3 grid.
struct Window {
  std::vector<float> depth = std::vector<float>(kColumns * kRows, 2.0F);
  std::vector<float> confidence = std::vector<float>(kColumns * kRows, 1.0F);
  int32_t id;
  unisim_depth_map map{};
  unisim_window_prediction prediction{};
  explicit Window(int32_t keyframe, double sigma = 0.001) : id(keyframe) {
    map = {depth.data(), confidence.data(), kColumns, kRows};
    prediction.count = 1;
    prediction.keyframe_ids = &id;
    prediction.depth = &map;
    prediction.focal_px = kFocal;
    prediction.center_sigma = sigma;
  }
};

unisim_pose pose_of(int32_t id, int32_t segment = 0) {
  unisim_pose pose{};
  pose.keyframe_id = id;
  pose.T_world_kf = {{0, 0, 0, 1}, {0, 0, 0}, 1};
  pose.confidence = 2;
  pose.segment = segment;
  return pose;
}

/// What places the views: poses of the keyframes, scales of the submaps.
struct Placing {
  std::vector<unisim_pose> keyframes;
  std::vector<double> submap_scale;
};

std::vector<Vertex> fuse(const Cloud& cloud, const Placing& placing, double k1 = 0.0,
                         double focal_px = 0.0) {
  const TempFolder folder;
  const std::string path = folder / "map.ply";
  RunData run;
  for (const unisim_pose& pose : placing.keyframes) run.keyframes.push_back({pose, 0, -1.0});
  run.submap_scale = placing.submap_scale;
  const int64_t count = cloud.write(path, run, {k1, focal_px});
  std::vector<Vertex> vertices = read_ply(path);
  CHECK(count == static_cast<int64_t>(vertices.size()));
  return vertices;
}

}  // namespace

TEST_CASE("points lie where pose, scale, focal length and depth put them") {
  const Picture picture;
  Cloud cloud;
  cloud.on_keyframe(0, picture.frame);
  cloud.on_window(0, Window(0).prediction);
  unisim_pose pose = pose_of(0);
  const double half = std::sqrt(0.5);
  pose.T_world_kf = {{0, 0, half, half}, {10, 20, 30}, 7};  // a quarter turn about z; scale unused
  const std::vector<Vertex> vertices = fuse(cloud, {{pose}, {0.5}});
  REQUIRE(vertices.size() == kColumns * kRows);
  // First cell: centre at 1/8 of the width, 1/6 of the height; depth 2 in submap units is 1.
  const double x = (0.125 - 0.5) * kWidth / kFocal;
  const double y = (1.0 / 6 - 0.5) * kHeight / kFocal;
  CHECK(vertices[0].x == Approx(10 - y));
  CHECK(vertices[0].y == Approx(20 + x));
  CHECK(vertices[0].z == Approx(31));
  CHECK(vertices[0].red == 200);
  CHECK(vertices[0].blue == 0);
  const auto right = std::max_element(vertices.begin(), vertices.end(),
                                      [](const Vertex& a, const Vertex& b) { return a.y < b.y; });
  CHECK(right->red == 0);
  CHECK(right->blue == 200);
  CHECK(vertices[0].confidence == 1.0F);
}

TEST_CASE("radial distortion is taken out") {
  const Picture picture;
  Cloud cloud;
  cloud.on_keyframe(0, picture.frame);
  cloud.on_window(0, Window(0).prediction);
  const auto plain = fuse(cloud, {{pose_of(0)}, {1.0}});
  const auto curved = fuse(cloud, {{pose_of(0)}, {1.0}}, -0.1);
  const double x = (0.125 - 0.5) * kWidth / kFocal;
  const double y = (1.0 / 6 - 0.5) * kHeight / kFocal;
  CHECK(curved[0].x / plain[0].x == Approx(1 - 0.1 * (x * x + y * y)));
  CHECK(curved[0].z == plain[0].z);
}

TEST_CASE("the least confident quarter is left out, and pixels without depth") {
  const Picture picture;
  Window window(0);
  for (size_t k = 0; k < window.confidence.size(); ++k) {
    window.confidence[k] = static_cast<float>(k);
  }
  Cloud cloud;
  cloud.on_keyframe(0, picture.frame);
  cloud.on_window(0, window.prediction);
  const auto vertices = fuse(cloud, {{pose_of(0)}, {1.0}});
  REQUIRE(vertices.size() == 9);
  CHECK(vertices[0].confidence == 3.0F);

  window.depth[11] = 0.0F;
  window.depth[10] = std::nanf("");
  Cloud holes;
  holes.on_keyframe(0, picture.frame);
  holes.on_window(0, window.prediction);
  const auto fewer = fuse(holes, {{pose_of(0)}, {1.0}});
  CHECK(fewer.size() == 8);  // of ten with depth the lowest two
  CHECK(std::any_of(fewer.begin(), fewer.end(),
                    [](const Vertex& v) { return v.confidence == 9.0F; }));
}

TEST_CASE("equal confidence drops nothing") {
  const Picture picture;
  Window window(0);
  window.map.confidence = nullptr;
  Cloud cloud;
  cloud.on_keyframe(0, picture.frame);
  cloud.on_window(0, window.prediction);
  CHECK(fuse(cloud, {{pose_of(0)}, {1.0}}).size() == kColumns * kRows);
}

TEST_CASE("pixels below a confidence asked for are left out") {
  const Picture picture;
  Window window(0);
  std::fill(window.confidence.begin(), window.confidence.end(), 0.25F);
  window.confidence[5] = 0.31F;
  CloudOptions options;
  options.min_confidence = 0.3;
  Cloud cloud(options);
  cloud.on_keyframe(0, picture.frame);
  cloud.on_window(0, window.prediction);
  CHECK(fuse(cloud, {{pose_of(0)}, {1.0}}).size() == 1);
}

TEST_CASE("a view has the depth of its most confident submap") {
  const Picture picture;
  Window good(0, 0.001);
  Window bad(0, 0.004);
  std::fill(bad.depth.begin(), bad.depth.end(), 5.0F);
  for (const bool good_first : {true, false}) {
    Cloud cloud;
    cloud.on_keyframe(0, picture.frame);
    cloud.on_window(0, good_first ? good.prediction : bad.prediction);
    cloud.on_window(1, good_first ? bad.prediction : good.prediction);
    CHECK(fuse(cloud, {{pose_of(0)}, {1.0, 1.0}})[0].z == 2.0F);
  }
  Window unknown(0, 0.0);
  std::fill(unknown.confidence.begin(), unknown.confidence.end(), 9.0F);
  Cloud cloud;
  cloud.on_keyframe(0, picture.frame);
  cloud.on_window(0, bad.prediction);
  cloud.on_window(1, unknown.prediction);
  CHECK(fuse(cloud, {{pose_of(0)}, {1.0, 1.0}})[0].z == 5.0F);
}

TEST_CASE("a revision changes the depth of its submap alone") {
  const Picture picture;
  Cloud cloud;
  for (int32_t id = 0; id < 2; ++id) {
    cloud.on_keyframe(id, picture.frame);
    cloud.on_window(id, Window(id).prediction);
  }
  const double ratio = std::log(1.5);
  unisim_window_revision revision{};
  revision.count = 1;
  revision.log_depth_ratio = &ratio;
  cloud.on_revision(1, revision);
  const auto vertices = fuse(cloud, {{pose_of(0), pose_of(1)}, {1.0, 1.0}});
  CHECK(vertices.front().z == 2.0F);
  CHECK(vertices.back().z == 3.0F);
}

TEST_CASE("a keyframe that has left the window keeps the depth it had") {
  const Picture picture;
  const TempFolder temporary;
  Cloud cloud({}, temporary.path());
  for (int32_t id = 0; id < 2; ++id) {
    cloud.on_keyframe(id, picture.frame);
    cloud.on_window(id, Window(id).prediction);
  }
  unisim_retired retired{};
  retired.keyframe_id = 0;
  cloud.on_retired(retired, nullptr);
  CHECK(cloud.views_in_memory() == 1);
  const double ratio = std::log(1.5);
  unisim_window_revision revision{};
  revision.count = 1;
  revision.log_depth_ratio = &ratio;
  cloud.on_revision(0, revision);
  cloud.on_revision(1, revision);
  const auto vertices = fuse(cloud, {{pose_of(0), pose_of(1)}, {1.0, 1.0}});
  REQUIRE(vertices.size() == size_t{2} * kColumns * kRows);
  CHECK(vertices.front().z == 2.0F);
  CHECK(vertices.back().z == 3.0F);
}

TEST_CASE("views in memory do not grow with the run, and none is lost") {
  const Picture picture;
  const TempFolder temporary;
  Cloud cloud({}, temporary.path());
  Placing placing;
  constexpr int32_t kKeyframes = 2 * Cloud::kViewsInMemory;
  for (int32_t id = 0; id < kKeyframes; ++id) {
    cloud.on_keyframe(id, picture.frame);
    cloud.on_window(id, Window(id).prediction);
    CHECK(cloud.views_in_memory() <= Cloud::kViewsInMemory);
    placing.keyframes.push_back(pose_of(id));
    placing.submap_scale.push_back(1.0);
  }
  CHECK(std::filesystem::is_empty(temporary.path()));
  CHECK(fuse(cloud, placing).size() == size_t{kKeyframes} * kColumns * kRows);
}

TEST_CASE("only the longest segment and supported poses give points") {
  const Picture picture;
  Cloud cloud;
  for (int32_t id = 0; id < 4; ++id) {
    cloud.on_keyframe(id, picture.frame);
    cloud.on_window(id, Window(id).prediction);
  }
  std::vector<unisim_pose> poses = {pose_of(0, 0), pose_of(1, 1), pose_of(2, 1), pose_of(3, 1)};
  poses[3].confidence = 0;
  CHECK(fuse(cloud, {poses, {1, 1, 1, 1}}).size() == size_t{2} * kColumns * kRows);
}

TEST_CASE("a large depth map is thinned to the grid, a missing image is grey") {
  unisim_frame frame{};
  frame.image = {nullptr, kWidth, kHeight, kWidth, UNISIM_PIXEL_GRAY8};
  const std::vector<float> depth(size_t{640} * 480, 1.0F);
  const unisim_depth_map map = {depth.data(), nullptr, 640, 480};
  Window window(0);
  window.prediction.depth = &map;
  Cloud cloud;
  cloud.on_keyframe(0, frame);
  cloud.on_window(0, window.prediction);
  const auto vertices = fuse(cloud, {{pose_of(0)}, {1.0}});
  CHECK(vertices.size() == size_t{80} * 60);
  CHECK(vertices[0].green == 128);
}

TEST_CASE("views of one surface are one surface: a point per cube") {
  const Picture picture;
  CloudOptions options;
  options.voxel = 0.07;  // of a depth of 2
  Cloud cloud(options);
  Placing placing;
  for (int32_t id = 0; id < 5; ++id) {
    cloud.on_keyframe(id, picture.frame);
    Window window(id);
    std::fill(window.depth.begin(), window.depth.end(), 2.04F + 0.002F * static_cast<float>(id));
    cloud.on_window(id, window.prediction);
    placing.keyframes.push_back(pose_of(id));
    placing.submap_scale.push_back(1.0);
  }
  const auto vertices = fuse(cloud, placing);
  REQUIRE(vertices.size() == kColumns * kRows);
  CHECK(vertices[0].z == Approx(2.044F));  // the mean of the five
  CHECK(vertices[0].red == 200);
  CHECK(vertices[0].confidence == 1.0F);
}

TEST_CASE("of a long run an even share of each view is in the cloud, of one surface all of it") {
  const Picture picture;
  CloudOptions options;
  options.voxel = 0.0001;  // each point has its own cube
  options.most_points = 60;
  Cloud apart(options);
  Cloud one_surface(options);
  Placing placing;
  for (int32_t id = 0; id < 10; ++id) {
    Window window(id);
    one_surface.on_keyframe(id, picture.frame);
    one_surface.on_window(id, window.prediction);
    std::fill(window.depth.begin(), window.depth.end(), 2.0F + 0.1F * static_cast<float>(id));
    apart.on_keyframe(id, picture.frame);
    apart.on_window(id, window.prediction);
    placing.keyframes.push_back(pose_of(id));
    placing.submap_scale.push_back(1.0);
  }
  const auto vertices = fuse(apart, placing);
  CHECK(vertices.size() == 60);
  for (int id = 0; id < 10; ++id) {
    const float depth = 2.0F + 0.1F * static_cast<float>(id);
    CHECK(std::count_if(vertices.begin(), vertices.end(),
                        [&](const Vertex& v) { return v.z == Approx(depth); }) == 6);
  }
  CHECK(fuse(one_surface, placing).size() == kColumns * kRows);
}

TEST_CASE("the focal length of one camera is the last estimate, those of a network are its own") {
  const Picture picture;
  for (const bool one : {true, false}) {
    CloudOptions options;
    options.one_camera = one;
    Cloud cloud(options);
    cloud.on_keyframe(0, picture.frame);
    cloud.on_window(0, Window(0).prediction);
    const auto vertices = fuse(cloud, {{pose_of(0)}, {1.0}}, 0.0, 2 * kFocal);
    const double x = (0.125 - 0.5) * kWidth / kFocal * 2.0;
    CHECK(vertices[0].x == Approx(one ? x / 2 : x));
    CHECK(vertices[0].z == 2.0F);
  }
}

TEST_CASE("with few sure pixels the rest is fitted to them") {
  const Picture picture;
  Window window(0);
  std::fill(window.depth.begin(), window.depth.end(), 9.0F);
  std::fill(window.confidence.begin(), window.confidence.end(), 0.4F);
  for (const size_t at : {0, 3, 8, 11}) {
    window.depth[at] = 2.0F;
    window.confidence[at] = 1.0F;
  }
  CloudOptions options;
  options.sure_confidence = unisim::replay::kGeometricSure;
  options.confidence_drop = 0.0;
  Cloud cloud(options);
  cloud.on_keyframe(0, picture.frame);
  cloud.on_window(0, window.prediction);
  const auto vertices = fuse(cloud, {{pose_of(0)}, {1.0}});
  REQUIRE(vertices.size() == kColumns * kRows);
  for (const Vertex& vertex : vertices) CHECK(vertex.z == Approx(2.0F));
}

TEST_CASE("a cloud that cannot be written says where") {
  const Cloud cloud;
  try {
    cloud.write("/proc/none/map.ply", {}, {});
    FAIL("no exception");
  } catch (const std::runtime_error& error) {
    CHECK(std::string(error.what()).find("/proc/none/map.ply: cannot be written") == 0);
  }
}
