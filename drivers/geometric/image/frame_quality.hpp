// SPDX-License-Identifier: MIT
// What is wrong with a frame, where tracking suffers from it.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>

namespace unisim::geometric {

/// An image in a few numbers.
struct ImageMeasures {
  double mean = 0.0;      ///< grey level, 0..255
  double contrast = 0.0;  ///< variance of the grey levels
  double detail = 0.0;    ///< mean squared difference of neighbours
  double edges = 0.0;     ///< share of pixels that differ clearly from those two beside
  double clipped = 0.0;   ///< share of pixels as dark or as bright as can be
  uint64_t print = 0;     ///< the same for the same pixels
};

/// Of every fourth row. O(pixels / 4).
ImageMeasures measure_image(const cv::Mat& gray);

/// One frame, as the tracking met it.
struct FrameEvidence {
  ImageMeasures image;
  int64_t timestamp_ns = 0;
  size_t tracks = 0;      ///< followed into it
  bool followed = false;  ///< there were tracks to follow
};

/// Says for each frame whether it is of little use and why: UNISIM_REASON_*. Compares with the
/// usual frame of the last second, so that a dim or soft camera is no reason; what goes on for
/// kPatience frames is usual. Changes nothing: what the tracker makes of a frame is its own affair.
class FrameQuality {
 public:
  static constexpr int kPatience = 90;

  int32_t see(const FrameEvidence& frame);

 private:
  /// Median over the last good frames.
  class Usual {
   public:
    void add(double value);
    double median() const;
    bool known() const { return count_ >= kLeast; }
    void forget() { count_ = next_ = 0; }

   private:
    static constexpr size_t kMost = 31;
    static constexpr size_t kLeast = 5;
    std::array<double, kMost> values_{};
    size_t count_ = 0;
    size_t next_ = 0;
  };

  int32_t judge(const FrameEvidence& frame) const;
  int32_t judge_image(const ImageMeasures& image) const;
  void learn(const FrameEvidence& frame, bool image_good);

  Usual mean_;
  Usual sharpness_;
  Usual detail_;
  Usual clipped_;
  Usual edges_;
  Usual interval_ns_;
  uint64_t last_print_ = 0;
  int64_t last_ns_ = 0;
  int unusual_ = 0;  // frames in a row
  bool first_ = true;
};

}  // namespace unisim::geometric
