// SPDX-License-Identifier: MIT
// From images to tracks: keeps the last frame's and the last keyframe's image and moves the tracks.
#pragma once

#include <array>
#include <opencv2/core.hpp>

#include "drivers/geometric/image/detector.hpp"
#include "drivers/geometric/image/frame_quality.hpp"
#include "drivers/geometric/image/frame_tracker.hpp"
#include "drivers/geometric/image/keyframe_retrack.hpp"
#include "drivers/geometric/image/local_contrast.hpp"
#include "drivers/geometric/image/prepared_image.hpp"
#include "drivers/geometric/image/tracks.hpp"
#include "drivers/geometric/zoom/zoom_jump.hpp"

namespace unisim::geometric {

/// How the tracks moved since the last keyframe.
struct TrackMotion {
  double displacement_px = -1;  ///< median; < 0: nothing to measure
  double kept = -1;             ///< share of the keyframe's tracks still followed
};

class FrontEnd {
 public:
  /// @param look where it is 0 nothing is followed; data NULL: everything may be
  void open(const cv::Size& size, int max_tracks, int spacing, const unisim_image& look);
  /// Takes the next frame and moves the tracks into it.
  /// @param timestamp_ns of the frame
  void see(const unisim_image& image, int64_t timestamp_ns, Tracks* tracks);
  int32_t reason() const { return reason_; }  ///< UNISIM_REASON_* of the frame seen last
  TrackMotion motion(const Tracks& tracks);
  /// The frame seen last is the one before at another scale.
  bool jumped() const { return jumped_; }

  /// The frame seen last becomes a keyframe: measures the tracks thoroughly.
  void begin_keyframe(Tracks* tracks);
  /// Corners for new tracks, see Detector::run().
  const std::vector<cv::Point2f>& detect(const Tracks& tracks);
  /// Of tracks too near each other the younger one goes.
  void space_out(Tracks* tracks);
  void end_keyframe(Tracks* tracks);

  /// Of the frame seen last, as it came.
  const cv::Mat& gray() const { return preparation_.gray(); }
  size_t sealed() const { return sealed_; }  ///< tracks at the last keyframe
  const PreparedImage& current() const { return images_[static_cast<size_t>(last_)]; }
  const PreparedImage& keyframe() const { return images_[static_cast<size_t>(keyframe_)]; }
  /// Is there a keyframe before the frame seen last?
  bool has_keyframe() const { return keyframe_ >= 0 && keyframe_ != last_; }
  const cv::Point2f& flow() const { return flow_; }  ///< median over the last frame
  /// Scratch of the image's size, set where nothing may be followed.
  cv::Mat* fresh_mask();
  int64_t bytes() const;

 private:
  void drop_hidden(Tracks* tracks) const;

  std::array<PreparedImage, 3> images_;  // last frame, last keyframe, the next one
  int last_ = -1;
  int keyframe_ = -1;
  cv::Size size_;
  int max_tracks_ = 0;
  int spacing_ = 1;
  size_t sealed_ = 0;  // tracks at the last keyframe
  cv::Point2f flow_{0.0F, 0.0F};
  cv::Mat hidden_;  // set where nothing may be followed; empty: nowhere
  cv::Mat mask_;
  ImagePreparation preparation_;
  LocalContrast contrast_;
  FrameTracker tracker_;
  ZoomJump jump_;
  FrameQuality quality_;
  int32_t reason_ = 0;
  bool jumped_ = false;
  std::vector<cv::Point2f> before_;  // the tracks in the frame before
  KeyframeRetrack retrack_;
  Detector detector_;
  std::vector<double> scratch_;
};

}  // namespace unisim::geometric
