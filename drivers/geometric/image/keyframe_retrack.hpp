// SPDX-License-Identifier: MIT
// At a keyframe, tracks are measured again from the patch of the last keyframe, so that small
// errors of the frame-to-frame steps do not add up.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "drivers/geometric/image/prepared_image.hpp"
#include "drivers/geometric/image/tracks.hpp"
#include "drivers/geometric/image/two_way_flow.hpp"

namespace unisim::geometric {

class KeyframeRetrack {
 public:
  void reserve(size_t count);
  /// Re-measures sealed tracks at full resolution with a backward check and removes those that
  /// fail.
  void run(const PreparedImage& last_keyframe, const PreparedImage& current, Tracks* tracks);

 private:
  TwoWayFlow flow_;
  std::vector<size_t> index_;  // of the flow's points among the tracks
  std::vector<uint8_t> bad_;
};

/// Removes the younger of two tracks closer than `distance`, and those where `mask` is set; the
/// others' surroundings are set in it.
void remove_crowded(int distance, cv::Mat* mask, Tracks* tracks);

}  // namespace unisim::geometric
