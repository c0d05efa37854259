// SPDX-License-Identifier: MIT
// At a keyframe, tracks are measured again from the patch of the last keyframe.
#include "drivers/geometric/image/keyframe_retrack.hpp"

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "drivers/geometric/image/frame_tracker.hpp"

namespace unisim::geometric {

namespace {
constexpr double kMaxBackwardError = 0.7;  // pixels
constexpr double kMaxCorrection = 2.0;     // pixels from where the frame-to-frame steps ended
}  // namespace

void KeyframeRetrack::reserve(size_t count) {
  for (auto* points : {&from_, &to_, &back_}) points->reserve(count);
  for (auto* flags : {&found_, &found_back_, &bad_}) flags->reserve(count);
  index_.reserve(count);
  error_.reserve(count);
}

void KeyframeRetrack::run(const PreparedImage& last_keyframe, const PreparedImage& current,
                          Tracks* tracks) {
  from_.clear();
  to_.clear();
  index_.clear();
  for (size_t i = 0; i < tracks->size(); ++i) {
    if (!tracks->sealed[i]) continue;
    from_.push_back(tracks->keyframe_point[i]);
    to_.push_back(tracks->point[i]);
    index_.push_back(i);
  }
  if (from_.empty()) return;
  back_ = from_;
  const cv::Size window(kTrackWindow, kTrackWindow);
  cv::calcOpticalFlowPyrLK(last_keyframe.pyramid, current.pyramid, from_, to_, found_, error_,
                           window, 0, track_criteria(), cv::OPTFLOW_USE_INITIAL_FLOW, kMinTexture);
  cv::calcOpticalFlowPyrLK(current.pyramid, last_keyframe.pyramid, to_, back_, found_back_, error_,
                           window, 0, track_criteria(), cv::OPTFLOW_USE_INITIAL_FLOW, kMinTexture);
  bad_.assign(tracks->size(), 0);
  for (size_t j = 0; j < index_.size(); ++j) {
    const size_t i = index_[j];
    const bool good = found_[j] && found_back_[j] &&
                      cv::norm(back_[j] - from_[j]) < kMaxBackwardError &&
                      cv::norm(to_[j] - tracks->point[i]) < kMaxCorrection &&
                      inside_image(to_[j], current.gray.size(), kTrackMargin);
    if (good) {
      tracks->point[i] = to_[j];
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
