// SPDX-License-Identifier: MIT
// Follows features from frame to frame with pyramidal Lucas-Kanade.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "drivers/geometric/image/prepared_image.hpp"
#include "drivers/geometric/image/tracks.hpp"

namespace unisim::geometric {

/// Moves every track from `previous` to `current`; those that cannot be followed are removed.
/// One direction only: the keyframe re-track makes the thorough check.
class FrameTracker {
 public:
  void reserve(size_t count);
  /// @return median displacement of the tracks since the previous frame
  cv::Point2f run(const PreparedImage& previous, const PreparedImage& current, Tracks* tracks);
  /// Median difference of the patches in the last run, gray values; < 0: nothing was followed.
  double patch_error() const { return patch_error_; }

 private:
  std::vector<cv::Point2f> next_;
  std::vector<uint8_t> found_;
  std::vector<uint8_t> bad_;
  std::vector<float> error_;
  std::vector<float> dx_;
  std::vector<float> dy_;
  double patch_error_ = -1;
};

/// Inside the image by a margin that tracking needs.
inline bool inside_image(const cv::Point2f& p, const cv::Size& size, float margin) {
  return p.x > margin && p.y > margin && p.x < static_cast<float>(size.width) - margin - 1 &&
         p.y < static_cast<float>(size.height) - margin - 1;
}

inline constexpr float kTrackMargin = 4.0F;

/// Least texture of a patch that Lucas-Kanade follows: a tenth of what OpenCV asks for, or it lets
/// go of the faint corners that the detector finds (a white cloth, a bare floor).
inline constexpr double kMinTexture = 1e-5;

/// Stop rule of every Lucas-Kanade call. Where there is little texture its steps are small: one
/// that stops early lags behind, always on the side it began from. See the README for the
/// measurement.
inline cv::TermCriteria track_criteria() {
  return {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 20, 0.003};
}

}  // namespace unisim::geometric
