// SPDX-License-Identifier: MIT
// Follows points from one image to another and back.
#include "drivers/geometric/image/two_way_flow.hpp"

#include <opencv2/video/tracking.hpp>

#include "drivers/geometric/image/frame_tracker.hpp"

namespace unisim::geometric {

void TwoWayFlow::reserve(size_t count) {
  for (auto* points : {&from_, &to_, &back_}) points->reserve(count);
  for (auto* flags : {&found_, &found_back_}) flags->reserve(count);
  error_.reserve(count);
}

void TwoWayFlow::clear() {
  from_.clear();
  to_.clear();
}

void TwoWayFlow::add(const cv::Point2f& from, const cv::Point2f& start) {
  from_.push_back(from);
  to_.push_back(start);
}

void TwoWayFlow::run(const std::vector<cv::Mat>& there, const std::vector<cv::Mat>& other,
                     int levels, double least_texture) {
  if (from_.empty()) return;
  back_ = from_;
  const cv::Size window(kTrackWindow, kTrackWindow);
  cv::calcOpticalFlowPyrLK(there, other, from_, to_, found_, error_, window, levels,
                           track_criteria(), cv::OPTFLOW_USE_INITIAL_FLOW, least_texture);
  cv::calcOpticalFlowPyrLK(other, there, to_, back_, found_back_, error_, window, levels,
                           track_criteria(), cv::OPTFLOW_USE_INITIAL_FLOW, least_texture);
}

}  // namespace unisim::geometric
