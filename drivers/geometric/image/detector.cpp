// SPDX-License-Identifier: MIT
// Finds new features where there are no tracks.
#include "drivers/geometric/image/detector.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <tuple>
#include <utility>

#include "drivers/geometric/image/frame_tracker.hpp"

namespace unisim::geometric {

namespace {
constexpr int kFastThreshold = 12;
// Where the image shows little. At 3 it is noise that is found.
constexpr int kFaintThreshold = 6;
// Faint corners are measured less well than strong ones: they are for images that have few of
// those (of the tracks wanted: a phone's orbit of a shoe half of them, a kitchen nine tenths).
constexpr double kFaintShare = 0.6;
constexpr int kFaintCell = 2;  // side of a cell in spacings
constexpr int kFastReach = 4;  // pixels around a corner that FAST and its suppression look at
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
  take_best(gray.size(), wanted, spacing, mask);
  const auto followed = static_cast<int>(tracks.size());
  const int enough = static_cast<int>(kFaintShare * (followed + wanted)) - followed;
  if (static_cast<int>(found_.size()) >= enough) return found_;
  look_in_empty_cells(gray, tracks, kFaintCell * spacing);
  take_best(gray.size(), enough, spacing, mask);
  return found_;
}

void Detector::take_best(const cv::Size& size, int wanted, int spacing, cv::Mat* mask) {
  std::sort(corners_.begin(), corners_.end(), [](const cv::KeyPoint& a, const cv::KeyPoint& b) {
    return std::tie(b.response, a.pt.y, a.pt.x) < std::tie(a.response, b.pt.y, b.pt.x);
  });
  for (const cv::KeyPoint& corner : corners_) {
    if (static_cast<int>(found_.size()) >= wanted) break;
    const cv::Point at(corner.pt);
    if (!inside_image(corner.pt, size, kDetectMargin) || mask->at<uint8_t>(at)) continue;
    cv::circle(*mask, at, spacing, cv::Scalar(255), -1);
    found_.push_back(corner.pt);
  }
}

void Detector::look_in_empty_cells(const cv::Mat& gray, const Tracks& tracks, int side) {
  const int columns = (gray.cols + side - 1) / side;
  const int rows = (gray.rows + side - 1) / side;
  occupied_.assign(static_cast<size_t>(columns) * static_cast<size_t>(rows), 0);
  for (const auto* points : {&tracks.point, &std::as_const(found_)}) {
    for (const cv::Point2f& p : *points) {
      const cv::Point cell(static_cast<int>(p.x) / side, static_cast<int>(p.y) / side);
      occupied_[static_cast<size_t>(cell.y * columns + cell.x)] = 1;
    }
  }
  corners_.clear();
  const cv::Rect image(cv::Point(0, 0), gray.size());
  for (int cell = 0; cell < columns * rows; ++cell) {
    if (occupied_[static_cast<size_t>(cell)]) continue;
    const cv::Point corner(cell % columns * side, cell / columns * side);
    const cv::Rect seen = image & cv::Rect(corner.x - kFastReach, corner.y - kFastReach,
                                           side + 2 * kFastReach, side + 2 * kFastReach);
    cv::FAST(gray(seen), cell_corners_, kFaintThreshold, true);
    for (cv::KeyPoint& faint : cell_corners_) {
      faint.pt += cv::Point2f(seen.tl());
      corners_.push_back(faint);
    }
  }
}

}  // namespace unisim::geometric
