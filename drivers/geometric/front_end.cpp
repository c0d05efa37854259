// SPDX-License-Identifier: MIT
// From images to tracks.
#include "drivers/geometric/front_end.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "drivers/common/image_mat.hpp"
#include "drivers/common/median.hpp"

namespace unisim::geometric {

namespace {
constexpr double kCrowded = 0.35;  // of the spacing between features
}  // namespace

void FrontEnd::open(const cv::Size& size, int max_tracks, int spacing, const unisim_image& look) {
  size_ = size;
  max_tracks_ = max_tracks;
  spacing_ = spacing;
  mask_.create(size, CV_8UC1);
  if (look.data != nullptr) {
    // A patch that reaches into what is hidden would be held fast by it.
    const cv::Size patch(kTrackWindow, kTrackWindow);
    cv::dilate(drivers::image_mat(look) == 0, hidden_,
               cv::getStructuringElement(cv::MORPH_RECT, patch));
  }
  const auto count = 2 * static_cast<size_t>(max_tracks);
  tracker_.reserve(count);
  retrack_.reserve(count);
  jump_.reserve(count);
  before_.reserve(count);
  scratch_.reserve(count);
}

void FrontEnd::see(const unisim_image& image, int64_t timestamp_ns, Tracks* tracks) {
  int next = 0;
  while (next == last_ || next == keyframe_) ++next;
  PreparedImage& prepared = images_[static_cast<size_t>(next)];
  preparation_.run(image, &prepared);
  if (last_ >= 0) {
    before_ = tracks->point;
    flow_ = tracker_.run(current(), prepared, tracks);
    jumped_ = jump_.see(current(), prepared, before_, tracker_.patch_error());
  }
  last_ = next;
  const bool followed = !before_.empty();
  drop_hidden(tracks);
  reason_ =
      quality_.see({measure_image(preparation_.gray()), timestamp_ns, tracks->size(), followed});
}

void FrontEnd::drop_hidden(Tracks* tracks) const {
  if (hidden_.empty()) return;
  std::vector<uint8_t> bad(tracks->size());
  for (size_t i = 0; i < bad.size(); ++i) bad[i] = hidden_.at<uint8_t>(cv::Point(tracks->point[i]));
  tracks->remove(bad);
}

cv::Mat* FrontEnd::fresh_mask() {
  if (hidden_.empty()) {
    mask_.setTo(0);
  } else {
    hidden_.copyTo(mask_);
  }
  return &mask_;
}

TrackMotion FrontEnd::motion(const Tracks& tracks) {
  scratch_.clear();
  for (size_t i = 0; i < tracks.size(); ++i) {
    if (tracks.sealed[i]) scratch_.push_back(cv::norm(tracks.point[i] - tracks.keyframe_point[i]));
  }
  TrackMotion out;
  if (sealed_ == 0) return out;
  out.kept = static_cast<double>(scratch_.size()) / static_cast<double>(sealed_);
  if (scratch_.empty()) return out;
  out.displacement_px = drivers::median(&scratch_);
  return out;
}

void FrontEnd::begin_keyframe(Tracks* tracks) {
  if (has_keyframe()) retrack_.run(keyframe(), current(), tracks);
  space_out(tracks);
}

void FrontEnd::space_out(Tracks* tracks) {
  remove_crowded(std::max(2, static_cast<int>(kCrowded * spacing_)), fresh_mask(), tracks);
}

const std::vector<cv::Point2f>& FrontEnd::detect(const Tracks& tracks) {
  const int wanted = max_tracks_ - static_cast<int>(tracks.size());
  const cv::Mat& raised = contrast_.run(preparation_.gray(), preparation_.mean());
  return detector_.run(raised, tracks, wanted, spacing_, fresh_mask());
}

void FrontEnd::end_keyframe(Tracks* tracks) {
  tracks->seal();
  sealed_ = tracks->size();
  keyframe_ = last_;
}

int64_t FrontEnd::bytes() const {
  const auto pixels = static_cast<int64_t>(size_.area());
  // Three prepared images, the mask, four bytes a pixel to prepare an image, five to raise it.
  return 3 * prepared_image_bytes(size_.width, size_.height) + 10 * pixels;
}

}  // namespace unisim::geometric
