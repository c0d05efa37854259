// SPDX-License-Identifier: MIT
// What the images showed while no start was found: so that a run without a map can say why.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>

#include "drivers/geometric/image/tracks.hpp"

namespace unisim::geometric {

/// What came of a try to start with a keyframe.
enum class StartOutcome {
  kStarted,
  kFirst,           ///< no earlier keyframe to start from
  kTooFewFeatures,  ///< the keyframe itself has too few
  kTracksDie,       ///< too few of an earlier keyframe's features are still followed
  kNotMoving,       ///< hardly any displacement
  kRotationOnly,    ///< displaced, but as by a turn on the spot
  kNoParallax,      ///< a relative pose, but the rays meet at too small angles
  kNoGeometry       ///< displaced, but not as a rigid scene seen by one camera
};
inline constexpr size_t kStartOutcomes = 8;

struct StartStatistics {
  int64_t frames = 0;
  int32_t keyframes = 0;
  std::array<int64_t, 256> levels{};  ///< how often each grey level was seen, sampled
  int64_t features = 0;               ///< of all keyframes together
  int32_t followed_keyframes = 0;     ///< keyframes after one that had features
  double followed = 0;                ///< sum of the shares still followed there
  int32_t moved_keyframes = 0;        ///< keyframes with features still followed
  double moved_px = 0;                ///< sum of the median displacements there
  int64_t resting = 0;                ///< features that stayed where they were between keyframes
  int64_t moving = 0;                 ///< features that clearly moved
  int32_t halves_compared = 0;        ///< keyframes whose left and right halves were compared
  int32_t halves_alike = 0;
  std::array<int32_t, kStartOutcomes> outcomes{};
  StartOutcome newest = StartOutcome::kFirst;

  /// @param gray the frame as it came
  void see_frame(const cv::Mat& gray);
  /// A keyframe whose tracks have been measured, but not yet filled up.
  /// @param sealed   tracks at the keyframe before
  /// @param prepared the frame with its local mean removed
  void see_keyframe(const Tracks& tracks, size_t sealed, double pixel_scale,
                    const cv::Mat& prepared);
  /// @param count features of the keyframe, new ones included
  void note_outcome(StartOutcome outcome, size_t count);

  /// Most frames hold the images of two eyes.
  bool two_eyes() const { return 2 * halves_alike > halves_compared; }
  /// Grey level below which `share` of the sampled pixels lie.
  int level(double share) const;
};

/// Two eyes side by side: the features of the left half are found again in the right one, in the
/// same row and not far from the same place.
/// @param prepared the frame with its local mean removed
bool halves_alike(const cv::Mat& prepared);

}  // namespace unisim::geometric
