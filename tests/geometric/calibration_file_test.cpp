// SPDX-License-Identifier: MIT
// Calibrations as the usual programs write them are read; what is none is refused in one line.
#include <string>

#include "drivers/geometric/geometric.h"
#include "tests/geometric/predictor_run.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/text.hpp"

namespace unisim::geometric::test {

namespace {

const char* const kOpenCv = R"(%YAML:1.0
---
calibration_time: "Mon 01 Jan 2024 10:00:00 AM CET"
nr_of_frames: 20
image_width: 640
image_height: 480
# flags: +fix_principal_point
flags: 6158
fisheye_model: 0
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 5.0e+02, 0., 3.10e+02, 0.,
       5.1e+02, 2.3e+02, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 5
   cols: 1
   dt: d
   data: [ -3.0e-01, 0.08, 1.0e-03, 2.0e-03, -0.01 ]
)";

const char* const kRos = R"(image_width: 640
image_height: 480
camera_name: narrow_stereo
camera_matrix:
  rows: 3
  cols: 3
  data: [500.0, 0.000000, 310.0, 0.0, 510.0, 230.0, 0.0, 0.0, 1.0]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.3, 0.08, 0.001, 0.002, -0.01]
rectification_matrix:
  rows: 3
  cols: 3
  data: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
)";

const char* const kCameraInfo = R"(header:
  stamp:
    sec: 1
    nanosec: 0
  frame_id: camera
height: 480
width: 640
distortion_model: plumb_bob
d:
- -0.3
- 0.08
- 0.001
- 0.002
- -0.01
k:
- 500.0
- 0.0
- 310.0
- 0.0
- 510.0
- 230.0
- 0.0
- 0.0
- 1.0
binning_x: 0
roi:
  do_rectify: false
---
height: 1
)";

const char* const kEuroc = R"(sensor_type: camera
rate_hz: 20
resolution: [640, 480]
camera_model: pinhole
intrinsics: [500, 510.0, 310.0, 230.0] #fu, fv, cu, cv
distortion_model: radial-tangential
distortion_coefficients: [-0.3, 0.08, 0.001, 0.002, -0.01]
)";

struct Read {
  unisim_geometric_config config = default_config();
  std::string message;
  bool good = false;
};

Read read(const std::string& text) {
  const TempFolder folder;
  Read out;
  char line[512] = "";
  const std::string path = folder.write("camera.yaml", text);
  out.good = unisim_geometric_read_calibration(path.c_str(), &out.config, line, sizeof line) != 0;
  out.message = line;
  return out;
}

std::string changed(std::string text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
  return text;
}

}  // namespace

TEST_CASE("the same camera is read from each program's file") {
  for (const char* text : {kOpenCv, kRos, kCameraInfo, kEuroc}) {
    INFO(text);
    const Read read_back = read(text);
    INFO(read_back.message);
    REQUIRE(read_back.good);
    const unisim_geometric_config& camera = read_back.config;
    CHECK(camera.focal_px == 500);
    CHECK(camera.focal_y_px == 510);
    CHECK(camera.principal_x_px == 310);
    CHECK(camera.principal_y_px == 230);
    CHECK(camera.calibrated_width == 640);
    CHECK(camera.calibrated_height == 480);
    CHECK(camera.distortion_model == UNISIM_DISTORTION_PINHOLE);
    const double terms[UNISIM_DISTORTION_TERMS] = {-0.3, 0.08, 0.001, 0.002, -0.01, 0, 0, 0};
    for (int i = 0; i < UNISIM_DISTORTION_TERMS; ++i) CHECK(camera.distortion[i] == terms[i]);
  }
}

TEST_CASE("a fisheye is known by its model's name or OpenCV's flag") {
  const std::string four = changed(kRos, "-0.3, 0.08, 0.001, 0.002, -0.01", "0.1, 0.2, 0.3, 0.4");
  const Read ros = read(changed(four, "plumb_bob", "equidistant"));
  CHECK(ros.good);
  CHECK(ros.config.distortion_model == UNISIM_DISTORTION_FISHEYE);
  CHECK(ros.config.distortion[3] == 0.4);
  CHECK_FALSE(read(changed(kOpenCv, "fisheye_model: 0", "fisheye_model: 1")).good);  // 5 terms
}

TEST_CASE("a file that holds no camera is refused with file and reason, and nothing is taken") {
  const struct {
    std::string text;
    const char* reason;
  } cases[] = {
      {"hello", "not YAML"},
      {"", "no keys"},
      {"a: [1, 2\nb: 3\n", "not YAML"},
      {"a: 1\n", "image_width is missing"},
      {changed(kRos, "camera_matrix", "matrix"), "camera_matrix is missing"},
      {changed(kRos, "distortion_coefficients", "d5"), "distortion_coefficients is missing"},
      {changed(kRos, "500.0,", ".nan,"), "no number"},
      {changed(kRos, "500.0,", "f,"), "no number"},
      {changed(kRos, "500.0,", "0.0,"), "not positive"},
      {changed(kRos, "500.0,", ""), "3x3"},
      {changed(kRos, "500.0, 0.000000,", "500.0, 3.0,"), "[fx 0 cx"},
      {changed(kRos, "310.0", "-310.0"), "principal"},
      {changed(kRos, "310.0", "700.0"), "principal"},
      {changed(kRos, "640", "640.5"), "image size"},
      {changed(kRos, "640", "0"), "image size"},
      {changed(kRos, "plumb_bob", "poly7"), "poly7"},
      {changed(kRos, "-0.3, 0.08, 0.001, 0.002, -0.01", "1, 2, 3, 4, 5, 6, 7, 8, 9"), "1 to 8"},
      {changed(kRos, "-0.3, 0.08, 0.001, 0.002, -0.01", ""), "1 to 8"},
  };
  for (const auto& bad : cases) {
    INFO(bad.text);
    const Read refused = read(bad.text);
    INFO(refused.message);
    CHECK_FALSE(refused.good);
    CHECK(has(refused.message, "camera.yaml: "));
    CHECK(has(refused.message, bad.reason));
    CHECK(refused.message.find('\n') == std::string::npos);
    CHECK(refused.config.focal_px == 0);
    CHECK(refused.config.calibrated_width == 0);
  }
  unisim_geometric_config config = default_config();
  char line[512] = "";
  CHECK(unisim_geometric_read_calibration("/nowhere/c.yaml", &config, line, sizeof line) == 0);
  CHECK(has(line, "/nowhere/c.yaml: cannot be read"));
}

TEST_CASE("a calibration fits frames of its shape and no other") {
  const unisim_geometric_config camera = read(kRos).config;
  char line[512] = "";
  CHECK(unisim_geometric_camera_fits(&camera, 640, 480, line, sizeof line) == 1);
  CHECK(unisim_geometric_camera_fits(&camera, 320, 240, line, sizeof line) == 1);
  CHECK(unisim_geometric_camera_fits(&camera, 1280, 720, line, sizeof line) == 0);
  CHECK(has(line, "640x480"));
  CHECK(has(line, "1280x720"));
}

}  // namespace unisim::geometric::test
