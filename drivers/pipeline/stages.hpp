// SPDX-License-Identifier: MIT
// The stages of a run by name, for all who tell their times.
#pragma once

#include "drivers/pipeline/latency_histogram.hpp"

namespace unisim::pipeline {

struct Stage {
  const char* name;
  LatencyHistogram StageTimes::* times;
};

/// In the order of a frame's way.
inline constexpr Stage kStages[] = {
    {"decode", &StageTimes::decode},
    {"observe", &StageTimes::observe},
    {"keyframe", &StageTimes::keyframe},
    {"two_view", &StageTimes::two_view},
    {"multi_view", &StageTimes::multi_view},
    {"revision", &StageTimes::revision},
    {"depth_ratio", &StageTimes::depth_ratio},
    {"descriptor", &StageTimes::descriptor},
    {"loop", &StageTimes::loop},
    {"graph", &StageTimes::graph},
    {"read", &StageTimes::read},
    {"optimize", &StageTimes::optimize},
    {"track_total", &StageTimes::track_total},
};

}  // namespace unisim::pipeline
