// SPDX-License-Identifier: MIT
// Finds new features where there are no tracks.
#include "drivers/geometric/detector.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <tuple>

#include "drivers/geometric/frame_tracker.hpp"

namespace unisim::geometric {

namespace {
constexpr int kFastThreshold = 12;
constexpr float kDetectMargin = 8.0F;
}  // namespace

const std::vector<cv::Point2f>& Detector::run(const cv::Mat& gray, const Tracks& tracks, int wanted,
                                              int spacing, cv::Mat* mask) {
  found_.clear();
  if (wanted <= 0) return found_;
  for (const cv::Point2f& p : tracks.point) {
    cv::circle(*mask, cv::Point(p), spacing, cv::Scalar(255), -1);
  }
  cv::FAST(gray, corners_, kFastThreshold, true);
  std::sort(corners_.begin(), corners_.end(), [](const cv::KeyPoint& a, const cv::KeyPoint& b) {
    return std::tie(b.response, a.pt.y, a.pt.x) < std::tie(a.response, b.pt.y, b.pt.x);
  });
  for (const cv::KeyPoint& corner : corners_) {
    if (static_cast<int>(found_.size()) >= wanted) break;
    const cv::Point at(corner.pt);
    if (!inside_image(corner.pt, gray.size(), kDetectMargin) || mask->at<uint8_t>(at)) continue;
    cv::circle(*mask, at, spacing, cv::Scalar(255), -1);
    found_.push_back(corner.pt);
  }
  return found_;
}

}  // namespace unisim::geometric
