// SPDX-License-Identifier: MIT
// What is wrong with a frame, where tracking suffers from it.
#include "drivers/geometric/image/frame_quality.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "drivers/predictor.h"

namespace unisim::geometric {
namespace {

constexpr int kRowStep = 4;
constexpr int kEdge = 12;    // grey levels over four pixels: noise stays below
constexpr int kDarkest = 4;  // grey levels
constexpr int kBrightest = 251;

// Chosen on 100 frames of redkitchen, as they are and covered, dimmed, overexposed, shaken, out of
// focus and before a wall (the worst good frame: 0.44 of the usual detail; the best bad one: 0.13),
// with a glance at beer (0.34). Shown on the others in the README.
constexpr double kDark = 60.0;          // grey levels: a hand on the lens lets some light through
constexpr double kDarkShare = 0.5;      // of the usual grey level
constexpr double kFlat = 0.01;          // share of edges
constexpr double kFlatShare = 0.1;      // of the usual edges
constexpr double kClipped = 0.5;        // share of the pixels
constexpr double kClippedMore = 0.25;   // than usual
constexpr double kBlurred = 0.25;       // of the usual detail, also for its contrast
constexpr double kLongInterval = 5.0;   // of the usual one
constexpr int64_t kLongNs = 150000000;  // a camera may miss a few frames
constexpr size_t kFewTracks = 30;

double sharpness(const ImageMeasures& image) {
  return image.detail / std::max(image.contrast, 1.0);
}

}  // namespace

ImageMeasures measure_image(const cv::Mat& gray) {
  int64_t sum = 0, square = 0, detail = 0, edges = 0, clipped = 0, count = 0;
  uint64_t print = 0xcbf29ce484222325ULL;
  for (int y = 2; y + 2 < gray.rows; y += kRowStep) {
    const auto* row = gray.ptr<uint8_t>(y);
    const auto* below = gray.ptr<uint8_t>(y + 1);
    const auto* up = gray.ptr<uint8_t>(y - 2);
    const auto* down = gray.ptr<uint8_t>(y + 2);
    for (int x = 2; x + 2 < gray.cols; ++x) {
      const int value = row[x];
      const int across = row[x + 1] - value;
      const int along = below[x] - value;
      sum += value;
      square += value * value;
      detail += across * across + along * along;
      edges += std::max(std::abs(row[x + 2] - row[x - 2]), std::abs(down[x] - up[x])) > kEdge;
      clipped += value <= kDarkest || value >= kBrightest;
      print = (print ^ static_cast<uint64_t>(value)) * 0x100000001b3ULL;
      ++count;
    }
  }
  ImageMeasures out;
  if (count == 0) return out;
  const auto n = static_cast<double>(count);
  out.mean = static_cast<double>(sum) / n;
  out.contrast = std::max(0.0, static_cast<double>(square) / n - out.mean * out.mean);
  out.detail = static_cast<double>(detail) / n;
  out.edges = static_cast<double>(edges) / n;
  out.clipped = static_cast<double>(clipped) / n;
  out.print = print;
  return out;
}

void FrameQuality::Usual::add(double value) {
  values_[next_] = value;
  next_ = (next_ + 1) % kMost;
  count_ = std::min(count_ + 1, kMost);
}

double FrameQuality::Usual::median() const {
  std::array<double, kMost> sorted = values_;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(count_ / 2);
  std::nth_element(sorted.begin(), middle, sorted.begin() + static_cast<std::ptrdiff_t>(count_));
  return *middle;
}

int32_t FrameQuality::judge_image(const ImageMeasures& image) const {
  const bool known = mean_.known();
  const bool flat = image.edges < kFlat && (!known || image.edges < kFlatShare * edges_.median());
  const bool darker = !known || image.mean < kDarkShare * mean_.median();
  if (flat && image.mean < kDark && darker) return UNISIM_REASON_COVERED;
  const double usual_clipped = known ? clipped_.median() : 0.0;
  if (image.clipped > std::max(kClipped, usual_clipped + kClippedMore))
    return UNISIM_REASON_EXPOSURE;
  if (flat) return UNISIM_REASON_TEXTURE;
  const bool blurred = known && image.detail < kBlurred * detail_.median() &&
                       sharpness(image) < kBlurred * sharpness_.median();
  return blurred ? UNISIM_REASON_BLUR : UNISIM_REASON_NONE;
}

int32_t FrameQuality::judge(const FrameEvidence& frame) const {
  if (!first_ && frame.image.print == last_print_) return UNISIM_REASON_DUPLICATE;
  const int32_t reason = judge_image(frame.image);
  if (reason != UNISIM_REASON_NONE) return reason;
  const int64_t interval = frame.timestamp_ns - last_ns_;
  if (!first_ && interval_ns_.known() && interval > kLongNs &&
      static_cast<double>(interval) > kLongInterval * interval_ns_.median()) {
    return UNISIM_REASON_TIME_GAP;
  }
  return frame.followed && frame.tracks < kFewTracks ? UNISIM_REASON_TEXTURE : UNISIM_REASON_NONE;
}

void FrameQuality::learn(const FrameEvidence& frame, bool image_good) {
  unusual_ = image_good ? 0 : unusual_ + 1;
  if (unusual_ > kPatience) {
    for (Usual* usual : {&mean_, &sharpness_, &detail_, &clipped_, &edges_}) usual->forget();
    unusual_ = 0;
    image_good = true;
  }
  if (image_good) {
    mean_.add(frame.image.mean);
    sharpness_.add(sharpness(frame.image));
    detail_.add(frame.image.detail);
    clipped_.add(frame.image.clipped);
    edges_.add(frame.image.edges);
  }
  if (!first_) interval_ns_.add(static_cast<double>(frame.timestamp_ns - last_ns_));
  last_ns_ = frame.timestamp_ns;
  last_print_ = frame.image.print;
  first_ = false;
}

int32_t FrameQuality::see(const FrameEvidence& frame) {
  const int32_t reason = judge(frame);
  learn(frame, judge_image(frame.image) == UNISIM_REASON_NONE);
  return reason;
}

}  // namespace unisim::geometric
