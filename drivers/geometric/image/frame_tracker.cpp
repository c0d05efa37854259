// SPDX-License-Identifier: MIT
// Follows features from frame to frame with pyramidal Lucas-Kanade.
#include "drivers/geometric/image/frame_tracker.hpp"

#include <opencv2/video/tracking.hpp>

#include "drivers/common/median.hpp"

namespace unisim::geometric {

void FrameTracker::reserve(size_t count) {
  next_.reserve(count);
  found_.reserve(count);
  bad_.reserve(count);
  error_.reserve(count);
  dx_.reserve(count);
  dy_.reserve(count);
}

cv::Point2f FrameTracker::run(const PreparedImage& previous, const PreparedImage& current,
                              Tracks* tracks) {
  patch_error_ = -1;
  if (tracks->size() == 0) return {0.0F, 0.0F};
  next_.resize(tracks->size());
  for (size_t i = 0; i < tracks->size(); ++i) next_[i] = tracks->point[i] + tracks->velocity[i];
  cv::calcOpticalFlowPyrLK(previous.pyramid, current.pyramid, tracks->point, next_, found_, error_,
                           cv::Size(kTrackWindow, kTrackWindow), kPyramidLevels, track_criteria(),
                           cv::OPTFLOW_USE_INITIAL_FLOW, kMinTexture);
  bad_.assign(tracks->size(), 0);
  dx_.clear();
  dy_.clear();
  size_t followed = 0;
  for (size_t i = 0; i < tracks->size(); ++i) {
    if (!found_[i] || !inside_image(next_[i], current.gray.size(), kTrackMargin)) {
      bad_[i] = 1;
      continue;
    }
    tracks->velocity[i] = next_[i] - tracks->point[i];
    tracks->point[i] = next_[i];
    dx_.push_back(tracks->velocity[i].x);
    dy_.push_back(tracks->velocity[i].y);
    error_[followed++] = error_[i];
  }
  tracks->remove(bad_);
  if (dx_.empty()) return {0.0F, 0.0F};
  error_.resize(followed);
  patch_error_ = static_cast<double>(drivers::median(&error_));
  return {drivers::median(&dx_), drivers::median(&dy_)};
}

}  // namespace unisim::geometric
