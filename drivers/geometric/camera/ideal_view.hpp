// SPDX-License-Identifier: MIT
// From the images of a calibrated camera to those of an ideal one, which the rest works on.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "drivers/geometric/geometric.h"

namespace unisim::geometric {

/// Images as a pinhole of the same focal length would take them: no distortion, the principal point
/// in the middle, square pixels. Adjustment, triangulation and depth then know one simple camera.
/// Images are mapped, not points: patches, features and tracks all see the same picture, and it
/// takes one pass of the image.
class IdealView {
 public:
  /// Changes `config` to what holds in the ideal image: its focal length, its mask.
  /// @param size of the frames
  /// @return an empty string, or why the calibration cannot be that of these frames
  std::string open(const cv::Size& size, unisim_geometric_config* config);

  /// What was given differs from an ideal camera; else images go on as they come.
  bool active() const { return !whole_.empty(); }
  /// Borrowed until the next run(); gray where `gray`.
  unisim_image run(const unisim_image& image, bool gray);
  /// Where a pixel of the ideal image lies in the image as it came.
  cv::Point2f place_in_image(const cv::Point2f& ideal) const;
  int64_t bytes() const;

 private:
  void hide_outside(const cv::Mat& x, const cv::Mat& y, unisim_geometric_config* config);

  cv::Mat whole_;  // of each ideal pixel: the whole pixel of the image left above its place ...
  cv::Mat parts_;  // ... and how far beyond, as cv::remap() wants it
  cv::Mat gray_;
  cv::Mat ideal_;
  std::vector<uint8_t> mask_;
};

}  // namespace unisim::geometric
