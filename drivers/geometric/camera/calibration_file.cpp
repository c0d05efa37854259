// SPDX-License-Identifier: MIT
// Reads a calibrated camera from YAML as OpenCV, ROS and EuRoC write it.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <initializer_list>
#include <opencv2/core.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "drivers/geometric/config.hpp"
#include "drivers/geometric/geometric.h"

namespace unisim::geometric {

namespace {

constexpr size_t kMostBytes = 1 << 20;  // a calibration is a page; a video is no calibration

[[noreturn]] void refuse(const std::string& what) { throw std::runtime_error(what); }

/// The first document as cv::FileStorage reads it: its own header, lists indented.
std::string as_opencv_yaml(std::istream& file) {
  std::string out = "%YAML:1.0\n---\n";
  bool begun = false;
  for (std::string line; std::getline(file, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    const bool mark = line.rfind("---", 0) == 0 || line.rfind("...", 0) == 0;
    if (mark && begun) break;
    if (mark || line.rfind("%YAML", 0) == 0) continue;
    begun = begun || !line.empty();
    if (line.rfind("- ", 0) == 0) line.insert(0, "  ");
    out += line + "\n";
    if (out.size() > kMostBytes) refuse("too long for a calibration; give a YAML file");
  }
  return out;
}

cv::FileNode find(const cv::FileNode& root, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    const cv::FileNode node = root[name];
    if (!node.empty()) return node;
  }
  refuse(std::string(*names.begin()) +
         " is missing; it is in what OpenCV and ROS calibrations write");
}

double number(const cv::FileNode& node, const std::string& name) {
  const double value = node.isInt() || node.isReal() ? node.real() : std::nan("");
  if (!std::isfinite(value)) refuse(name + " holds something that is no number");
  return value;
}

/// Numbers of a list or of a matrix.
std::vector<double> numbers(const cv::FileNode& node, const std::string& name) {
  const cv::FileNode list = node.isMap() ? node["data"] : node;
  if (!list.isSeq()) refuse(name + " is no list of numbers");
  std::vector<double> out;
  for (const cv::FileNode& item : list) out.push_back(number(item, name));
  return out;
}

int32_t whole_side(double value) {
  if (!(value >= 1 && value <= 100000 && value == std::floor(value))) {
    refuse("the image size is not two whole numbers of pixels");
  }
  return static_cast<int32_t>(value);
}

void take_size(const cv::FileNode& root, unisim_geometric_config* out) {
  if (!root["resolution"].empty()) {
    const std::vector<double> sides = numbers(root["resolution"], "resolution");
    if (sides.size() != 2) refuse("resolution is not two numbers");
    out->calibrated_width = whole_side(sides[0]);
    out->calibrated_height = whole_side(sides[1]);
    return;
  }
  out->calibrated_width =
      whole_side(number(find(root, {"image_width", "image_Width", "width"}), "image_width"));
  out->calibrated_height =
      whole_side(number(find(root, {"image_height", "image_Height", "height"}), "image_height"));
}

void take_matrix(const cv::FileNode& root, unisim_geometric_config* out) {
  std::vector<double> k = numbers(
      find(root, {"camera_matrix", "Camera_Matrix", "K", "k", "intrinsics"}), "camera_matrix");
  if (k.size() == 4) k = {k[0], 0, k[2], 0, k[1], k[3], 0, 0, 1};
  if (k.size() != 9) refuse("camera_matrix is not 3x3");
  // A pixel grid that is not at right angles is a wrong line far more often than a camera.
  const bool pinhole = k[1] == 0 && k[3] == 0 && k[6] == 0 && k[7] == 0 && k[8] == 1;
  if (!pinhole) refuse("camera_matrix is not [fx 0 cx; 0 fy cy; 0 0 1]");
  if (!(k[0] > 0 && k[4] > 0))
    refuse("the focal length is not positive: the camera is not calibrated");
  const bool inside =
      k[2] > 0 && k[5] > 0 && k[2] < out->calibrated_width - 1 && k[5] < out->calibrated_height - 1;
  if (!inside) refuse("the principal point is not inside the image");
  out->focal_px = k[0];
  out->focal_y_px = k[4];
  out->principal_x_px = k[2];
  out->principal_y_px = k[5];
}

int32_t model_of(const cv::FileNode& root) {
  const cv::FileNode fisheye = root["fisheye_model"];
  if (fisheye.isInt() && static_cast<int>(fisheye) != 0) return UNISIM_DISTORTION_FISHEYE;
  const cv::FileNode node = root["distortion_model"];
  if (node.empty()) return UNISIM_DISTORTION_PINHOLE;  // OpenCV names none
  const std::string name = node.isString() ? node.string() : "";
  for (const char* known : {"plumb_bob", "rational_polynomial", "radial-tangential", "radtan"}) {
    if (name == known) return UNISIM_DISTORTION_PINHOLE;
  }
  for (const char* known : {"equidistant", "fisheye"}) {
    if (name == known) return UNISIM_DISTORTION_FISHEYE;
  }
  refuse("distortion_model \"" + name +
         "\" is not known; plumb_bob, rational_polynomial, radial-tangential and equidistant are");
}

void take_distortion(const cv::FileNode& root, unisim_geometric_config* out) {
  const char* const name = "distortion_coefficients";
  const std::vector<double> terms =
      numbers(find(root, {name, "Distortion_Coefficients", "distortion_coeffs", "D", "d"}), name);
  out->distortion_model = model_of(root);
  const size_t most =
      out->distortion_model == UNISIM_DISTORTION_FISHEYE ? 4 : UNISIM_DISTORTION_TERMS;
  const bool beyond =
      std::any_of(terms.begin() + static_cast<std::ptrdiff_t>(std::min(most, terms.size())),
                  terms.end(), [](double term) { return term != 0; });
  // OpenCV writes 14 where 8 are used.
  if (terms.empty() || beyond) {
    refuse(std::string(name) + " are " + std::to_string(terms.size()) + ", must be 1 to " +
           std::to_string(most));
  }
  std::fill(out->distortion, out->distortion + UNISIM_DISTORTION_TERMS, 0.0);
  std::copy_n(terms.begin(), std::min(most, terms.size()), out->distortion);
}

unisim_geometric_config read_file(const std::string& path, const unisim_geometric_config& config) {
  std::ifstream file(path);
  const std::string text = as_opencv_yaml(file);
  if (!file.eof() && file.fail()) refuse("cannot be read; give the YAML file of a calibration");
  unisim_geometric_config out = config;
  try {
    const cv::FileStorage storage(text, cv::FileStorage::READ | cv::FileStorage::MEMORY);
    const cv::FileNode root = storage.root();
    if (!root.isMap()) refuse("holds no keys; give the YAML file of a calibration");
    take_size(root, &out);
    take_matrix(root, &out);
    take_distortion(root, &out);
  } catch (const cv::Exception&) {  // what it says is for its own developers
    refuse("is not YAML as OpenCV reads it; give the file of a calibration");
  }
  return out;
}

}  // namespace

}  // namespace unisim::geometric

int32_t unisim_geometric_read_calibration(const char* path, unisim_geometric_config* config,
                                          char* message, size_t capacity) {
  std::string problem;
  try {
    const unisim_geometric_config found = unisim::geometric::read_file(path, *config);
    problem = unisim::geometric::read_config(&found, config);
    if (problem.empty()) return 1;
  } catch (const std::exception& error) {
    problem = error.what();
  }
  if (message != nullptr && capacity > 0) {
    std::snprintf(message, capacity, "%s: %s", path, problem.c_str());
  }
  return 0;
}
