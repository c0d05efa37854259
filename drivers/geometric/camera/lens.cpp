// SPDX-License-Identifier: MIT
// A known lens: where each pixel of the ideal image lies in the image it gives.
#include "drivers/geometric/camera/lens.hpp"

#include <cmath>
#include <cstdio>
#include <opencv2/calib3d.hpp>

#include "drivers/common/size_text.hpp"

namespace unisim::geometric {

namespace {

constexpr double kSteps = 1000;  // in which the turning point of a polynomial is looked for

cv::Point2d middle(const cv::Size& size) {
  return {size.width / 2.0 - 0.5, size.height / 2.0 - 0.5};
}

cv::Matx33d matrix(double focal_x, double focal_y, const cv::Point2d& principal) {
  return {focal_x, 0, principal.x, 0, focal_y, principal.y, 0, 0, 1};
}

/// Distance from the principal point, in focal lengths, at which a ray of slope `r` is imaged.
double imaged_radius(const Lens& lens, double r) {
  const auto k = [&](int i) { return lens.coefficients.at<double>(i); };
  if (lens.model == UNISIM_DISTORTION_FISHEYE) {
    const double a = std::atan(r);
    const double a2 = a * a;
    return a * (1 + a2 * (k(0) + a2 * (k(1) + a2 * (k(2) + a2 * k(3)))));
  }
  const double r2 = r * r;
  const double below = 1 + r2 * (k(5) + r2 * (k(6) + r2 * k(7)));
  if (!(below > 0)) return 0;
  return r * (1 + r2 * (k(0) + r2 * (k(1) + r2 * k(4)))) / below;
}

/// The slope up to which rays farther out are imaged farther out, `most` at most.
double turning_slope(const Lens& lens, double most) {
  double last = 0;
  for (int i = 1; i <= static_cast<int>(kSteps); ++i) {
    const double next = imaged_radius(lens, most * i / kSteps);
    if (!(next > last)) return most * (i - 1) / kSteps;
    last = next;
  }
  return most;
}

}  // namespace

double Lens::focal() const { return std::sqrt(focal_x * focal_y); }

std::string lens_of(const unisim_geometric_config& config, const cv::Size& size, Lens* out) {
  const int32_t width = config.calibrated_width > 0 ? config.calibrated_width : size.width;
  const int32_t height = config.calibrated_height > 0 ? config.calibrated_height : size.height;
  // Sides are whole pixels: the scaled height may be off by one.
  const double scale = static_cast<double>(size.width) / width;
  if (std::abs(height * scale - size.height) > 1.0) {
    return "the camera was calibrated with " + drivers::size_text(width, height) +
           " pixels, the images have " + drivers::size_text(size.width, size.height) +
           ", another shape; calibrate with images of the same shape, uncropped";
  }
  out->focal_x = config.focal_px * scale;
  out->focal_y = (config.focal_y_px > 0 ? config.focal_y_px : config.focal_px) * scale;
  out->principal = middle(size);
  if (config.principal_x_px > 0) {
    out->principal = {(config.principal_x_px + 0.5) * scale - 0.5,
                      (config.principal_y_px + 0.5) * scale - 0.5};
  }
  if (out->principal.x > size.width - 1 || out->principal.y > size.height - 1) {
    return "the principal point lies outside the images of " +
           drivers::size_text(size.width, size.height) +
           " pixels; it is in pixels from their corner";
  }
  out->model = config.distortion_model;
  const int terms = out->model == UNISIM_DISTORTION_FISHEYE ? 4 : UNISIM_DISTORTION_TERMS;
  cv::Mat(1, terms, CV_64F, const_cast<double*>(config.distortion)).copyTo(out->coefficients);
  return {};
}

void map_lens(const Lens& lens, const cv::Size& size, cv::Mat* x, cv::Mat* y) {
  // Without a focal length there is no distortion either, and any will do for the shift.
  const double focal = lens.focal_x > 0 ? lens.focal() : size.width;
  const cv::Matx33d camera = lens.focal_x > 0 ? matrix(lens.focal_x, lens.focal_y, lens.principal)
                                              : matrix(focal, focal, lens.principal);
  const cv::Point2d center = middle(size);
  const cv::Matx33d ideal = matrix(focal, focal, center);
  if (lens.model == UNISIM_DISTORTION_FISHEYE) {
    cv::fisheye::initUndistortRectifyMap(camera, lens.coefficients, cv::Matx33d::eye(), ideal, size,
                                         CV_32FC1, *x, *y);
  } else {
    cv::initUndistortRectifyMap(camera, lens.coefficients, cv::noArray(), ideal, size, CV_32FC1, *x,
                                *y);
  }
  const double farthest = std::hypot(center.x, center.y) / focal;
  const double turn = turning_slope(lens, farthest);
  if (turn >= farthest) return;
  for (int row = 0; row < size.height; ++row) {
    for (int column = 0; column < size.width; ++column) {
      if (std::hypot(column - center.x, row - center.y) < turn * focal) continue;
      x->at<float>(row, column) = y->at<float>(row, column) = -1.0F;
    }
  }
}

}  // namespace unisim::geometric

int32_t unisim_geometric_camera_fits(const unisim_geometric_config* config, int32_t width,
                                     int32_t height, char* message, size_t capacity) {
  unisim::geometric::Lens lens;
  const std::string problem = unisim::geometric::lens_of(*config, {width, height}, &lens);
  if (problem.empty()) return 1;
  if (message != nullptr && capacity > 0) std::snprintf(message, capacity, "%s", problem.c_str());
  return 0;
}
