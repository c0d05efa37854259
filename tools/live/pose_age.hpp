// SPDX-License-Identifier: MIT
// How old a pose is when it is given out: from the frame's time stamp to now.
#pragma once

#include <cstdint>

#include "drivers/pipeline/latency_histogram.hpp"
#include "drivers/pipeline/listener.hpp"

namespace unisim::live {

/// Where the clock of the stamps is known, that of the camera, ages are true. Stamps of a recording
/// have a clock of their own: the frame that came soonest after its stamp counts as new.
class PoseAge : public pipeline::Listener {
 public:
  /// Where it is known. @param offset_ns stamps minus CLOCK_MONOTONIC
  void set_stamp_clock(int64_t offset_ns) {
    known_ = true;
    offset_ns_ = offset_ns;
  }

  void on_live_pose(const pipeline::LivePose& pose) override;

  const pipeline::LatencyHistogram& ages() const { return ages_; }

  /// Whether they are true ages.
  bool known() const { return known_; }

 private:
  bool known_ = false;
  int64_t offset_ns_ = 0;  // of the stamps' clock to ours
  bool started_ = false;
  pipeline::LatencyHistogram ages_;
};

/// CLOCK_MONOTONIC, nanoseconds.
int64_t monotonic_ns();

}  // namespace unisim::live
