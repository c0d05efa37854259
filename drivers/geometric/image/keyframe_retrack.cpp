// SPDX-License-Identifier: MIT
// At a keyframe, tracks are measured again from the patch of the last keyframe.
#include "drivers/geometric/image/keyframe_retrack.hpp"

#include <opencv2/imgproc.hpp>

#include "drivers/geometric/image/frame_tracker.hpp"

namespace unisim::geometric {

namespace {
constexpr double kMaxBackwardError = 0.7;  // pixels
constexpr double kMaxCorrection = 2.0;     // pixels from where the frame-to-frame steps ended
}  // namespace

void KeyframeRetrack::reserve(size_t count) {
  flow_.reserve(count);
  bad_.reserve(count);
  index_.reserve(count);
}

void KeyframeRetrack::run(const PreparedImage& last_keyframe, const PreparedImage& current,
                          Tracks* tracks) {
  flow_.clear();
  index_.clear();
  for (size_t i = 0; i < tracks->size(); ++i) {
    if (!tracks->sealed[i]) continue;
    flow_.add(tracks->keyframe_point[i], tracks->point[i]);
    index_.push_back(i);
  }
  flow_.run(last_keyframe.pyramid, current.pyramid, 0, kMinTexture);
  bad_.assign(tracks->size(), 0);
  for (size_t j = 0; j < index_.size(); ++j) {
    const size_t i = index_[j];
    const bool good = flow_.came_back(j, kMaxBackwardError) &&
                      cv::norm(flow_.to(j) - tracks->point[i]) < kMaxCorrection &&
                      inside_image(flow_.to(j), current.gray.size(), kTrackMargin);
    if (good) {
      tracks->point[i] = flow_.to(j);
    } else {
      bad_[i] = 1;
    }
  }
  tracks->remove(bad_);
}

void remove_crowded(int distance, cv::Mat* mask, Tracks* tracks) {
  std::vector<uint8_t> bad(tracks->size(), 0);
  for (size_t i = 0; i < tracks->size(); ++i) {
    const cv::Point at(tracks->point[i]);
    if (mask->at<uint8_t>(at)) {
      bad[i] = 1;
    } else {
      cv::circle(*mask, at, distance, cv::Scalar(255), -1);
    }
  }
  tracks->remove(bad);
}

}  // namespace unisim::geometric
