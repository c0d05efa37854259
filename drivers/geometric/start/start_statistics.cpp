// SPDX-License-Identifier: MIT
// What the images showed while no start was found.
#include "drivers/geometric/start/start_statistics.hpp"

#include <algorithm>
#include <vector>

#include "drivers/common/median.hpp"

namespace unisim::geometric {

namespace {

constexpr int kSampleStep = 4;           // pixels between the samples of a frame's grey levels
constexpr double kRestingPx = 0.5;       // what the tracker's noise alone may move a feature
constexpr double kMovingPx = 3.0;        // at the reference diagonal: well beyond that noise
constexpr int32_t kHalvesCompared = 16;  // keyframes that settle it

}  // namespace

void StartStatistics::see_frame(const cv::Mat& gray) {
  ++frames;
  for (int y = kSampleStep / 2; y < gray.rows; y += kSampleStep) {
    const uint8_t* row = gray.ptr<uint8_t>(y);
    for (int x = kSampleStep / 2; x < gray.cols; x += kSampleStep) ++levels[row[x]];
  }
}

void StartStatistics::see_keyframe(const Tracks& tracks, size_t sealed, double pixel_scale,
                                   const cv::Mat& prepared) {
  ++keyframes;
  if (halves_compared < kHalvesCompared) {
    ++halves_compared;
    halves_alike += geometric::halves_alike(prepared) ? 1 : 0;
  }
  if (sealed == 0) return;
  ++followed_keyframes;
  followed += static_cast<double>(tracks.size()) / static_cast<double>(sealed);
  if (tracks.size() == 0) return;
  std::vector<double> moved(tracks.size());
  for (size_t i = 0; i < tracks.size(); ++i) {
    moved[i] = cv::norm(tracks.point[i] - tracks.keyframe_point[i]);
    resting += moved[i] < kRestingPx ? 1 : 0;
    moving += moved[i] > std::max(2 * kRestingPx, kMovingPx * pixel_scale) ? 1 : 0;
  }
  ++moved_keyframes;
  moved_px += drivers::median(&moved);
}

void StartStatistics::note_outcome(StartOutcome outcome, size_t count) {
  features += static_cast<int64_t>(count);
  ++outcomes[static_cast<size_t>(outcome)];
  newest = outcome;
}

int StartStatistics::level(double share) const {
  int64_t total = 0;
  for (const int64_t count : levels) total += count;
  int64_t below = 0;
  for (size_t value = 0; value < levels.size(); ++value) {
    below += levels[value];
    if (total > 0 && static_cast<double>(below) >= share * static_cast<double>(total)) {
      return static_cast<int>(value);
    }
  }
  return 0;
}

}  // namespace unisim::geometric
