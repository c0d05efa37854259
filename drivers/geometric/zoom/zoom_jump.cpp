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
  flow_.reserve(points);
  for (auto* list : {&scaled_, &found_}) list->reserve(points);
  agree_.reserve(points);
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
    flow_.clear();
    for (size_t i = 0; i < points.size(); i += step) {
      const cv::Point2f at = centre + s * (points[i] - centre);
      if (inside_image(at, size, kTrackMargin)) flow_.add(at, at);
    }
    const size_t seen = flow_.size();
    if (seen < kLeastPoints || match(current) < kLeastPoints) continue;
    const cv::Mat fit =
        cv::estimateAffinePartial2D(scaled_, found_, agree_, cv::RANSAC, kSameScale);
    if (fit.empty()) continue;
    const double whole = scale * std::hypot(fit.at<double>(0, 0), fit.at<double>(1, 0));
    const double share = static_cast<double>(cv::countNonZero(agree_)) / static_cast<double>(seen);
    if (share >= kLeastShare && std::fabs(std::log(whole)) >= std::log(kLeastJump)) return true;
  }
  return false;
}

size_t ZoomJump::match(const PreparedImage& current) {
  flow_.run(pyramid_, current.pyramid, kPyramidLevels, kUsualTexture);
  scaled_.clear();
  found_.clear();
  for (size_t i = 0; i < flow_.size(); ++i) {
    if (!flow_.came_back(i, kMaxBackwardError)) continue;
    if (!inside_image(flow_.to(i), current.gray.size(), kTrackMargin)) continue;
    scaled_.push_back(flow_.from(i));
    found_.push_back(flow_.to(i));
  }
  return scaled_.size();
}

}  // namespace unisim::geometric
