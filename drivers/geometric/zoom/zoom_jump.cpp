// SPDX-License-Identifier: MIT
// Notices a frame that is the one before, enlarged or reduced.
#include "drivers/geometric/zoom/zoom_jump.hpp"

#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "drivers/geometric/image/frame_tracker.hpp"

namespace unisim::geometric {

namespace {
// Patch errors of a jump are four times those of the frames before, others rarely twice.
constexpr double kSuddenError = 2.0;
constexpr double kForget = 0.1;
// Tracks stand a scale of 15 %: neighbours are that far from what lies between them.
constexpr double kScales[] = {0.5, 0.57, 0.66, 0.76, 1.32, 1.52, 1.75, 2.0};
constexpr size_t kMostPoints = 100;
constexpr size_t kLeastPoints = 15;
constexpr double kMaxBackwardError = 0.7;  // pixels
constexpr double kSameScale = 3.0;         // pixels from one similarity of all points
// Of the frames of all recordings none comes near: jumps of 1.5 give a scale within 3 % of it and
// 33 to 97 % of the points agree, fast motion at a tenth of the frames up to 1.14 and 25 %.
constexpr double kLeastJump = 1.25;
constexpr double kLeastShare = 0.3;
}  // namespace

void ZoomJump::reserve(size_t points) {
  for (auto* list : {&scaled_, &found_, &back_}) list->reserve(points);
  for (auto* flags : {&forward_ok_, &back_ok_}) flags->reserve(points);
  patch_error_.reserve(points);
}

bool ZoomJump::stands_out(double error) {
  const bool sudden = usual_error_ > 0 && error > kSuddenError * usual_error_;
  usual_error_ = usual_error_ < 0 ? error : usual_error_ + kForget * (error - usual_error_);
  return sudden;
}

bool ZoomJump::see(const PreparedImage& previous, const PreparedImage& current,
                   const std::vector<cv::Point2f>& points, double error) {
  if (points.size() < kLeastPoints || error < 0) return false;
  return stands_out(error) && search(previous, current, points);
}

bool ZoomJump::search(const PreparedImage& previous, const PreparedImage& current,
                      const std::vector<cv::Point2f>& points) {
  const cv::Size size = previous.gray.size();
  const cv::Point2f centre(0.5F * static_cast<float>(size.width - 1),
                           0.5F * static_cast<float>(size.height - 1));
  const size_t step = (points.size() - 1) / kMostPoints + 1;
  for (const double scale : kScales) {
    const auto s = static_cast<float>(scale);
    const cv::Matx23f about_centre(s, 0, (1 - s) * centre.x, 0, s, (1 - s) * centre.y);
    cv::warpAffine(previous.gray, warped_, about_centre, size, cv::INTER_LINEAR,
                   cv::BORDER_REPLICATE);
    cv::buildOpticalFlowPyramid(warped_, pyramid_, cv::Size(kTrackWindow, kTrackWindow),
                                kPyramidLevels, true);
    scaled_.clear();
    for (size_t i = 0; i < points.size(); i += step) {
      const cv::Point2f at = centre + s * (points[i] - centre);
      if (inside_image(at, size, kTrackMargin)) scaled_.push_back(at);
    }
    const size_t seen = scaled_.size();
    if (seen < kLeastPoints || match(current) < kLeastPoints) continue;
    const cv::Mat fit =
        cv::estimateAffinePartial2D(scaled_, found_, forward_ok_, cv::RANSAC, kSameScale);
    if (fit.empty()) continue;
    const double whole = scale * std::hypot(fit.at<double>(0, 0), fit.at<double>(1, 0));
    const double share =
        static_cast<double>(cv::countNonZero(forward_ok_)) / static_cast<double>(seen);
    if (share >= kLeastShare && std::fabs(std::log(whole)) >= std::log(kLeastJump)) return true;
  }
  return false;
}

size_t ZoomJump::match(const PreparedImage& current) {
  const cv::Size window(kTrackWindow, kTrackWindow);
  found_ = scaled_;
  cv::calcOpticalFlowPyrLK(pyramid_, current.pyramid, scaled_, found_, forward_ok_, patch_error_,
                           window, kPyramidLevels, track_criteria(), cv::OPTFLOW_USE_INITIAL_FLOW);
  back_ = scaled_;
  cv::calcOpticalFlowPyrLK(current.pyramid, pyramid_, found_, back_, back_ok_, patch_error_, window,
                           kPyramidLevels, track_criteria(), cv::OPTFLOW_USE_INITIAL_FLOW);
  size_t kept = 0;
  for (size_t i = 0; i < scaled_.size(); ++i) {
    if (!forward_ok_[i] || !back_ok_[i]) continue;
    if (cv::norm(back_[i] - scaled_[i]) >= kMaxBackwardError) continue;
    if (!inside_image(found_[i], current.gray.size(), kTrackMargin)) continue;
    scaled_[kept] = scaled_[i];
    found_[kept++] = found_[i];
  }
  scaled_.resize(kept);
  found_.resize(kept);
  return kept;
}

}  // namespace unisim::geometric
