// SPDX-License-Identifier: MIT
// How long it takes from the kernel's stamp of a frame to a pose that is given out.
#include "tests/v4l2/vivid/pose_ages.hpp"

#include <time.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <vector>

#include "drivers/pipeline/pipeline.hpp"
#include "tests/pipeline/scripted_world.hpp"

namespace {

/// The clock of the driver's stamps.
int64_t monotonic_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return int64_t{1000000000} * now.tv_sec + now.tv_nsec;
}

struct Ages : unisim::pipeline::Listener {
  explicit Ages(int wanted) : most(static_cast<size_t>(wanted)) {}

  void on_live_pose(const unisim::pipeline::LivePose& pose) override {
    const int64_t age_ns = monotonic_ns() - pose.timestamp_ns;
    in_order = in_order && age_ns >= 0 && pose.timestamp_ns > last_ns;
    last_ns = pose.timestamp_ns;
    ms.push_back(1e-6 * static_cast<double>(age_ns));
    if (ms.size() >= most) enough = true;
  }

  size_t most;
  std::vector<double> ms;
  int64_t last_ns = 0;
  bool in_order = true;
  std::atomic<bool> enough{false};
};

double percentile(const std::vector<double>& sorted, double share) {
  return sorted.empty()
             ? 0.0
             : sorted[static_cast<size_t>(share * static_cast<double>(sorted.size() - 1))];
}

}  // namespace

std::string PoseAges::text() const {
  char line[160];
  std::snprintf(line, sizeof line, "%d poses, from stamp to pose p50 %.1f ms, p95 %.1f ms", poses,
                p50_ms, p95_ms);
  return line;
}

PoseAges pose_ages(unisim_source* camera, int poses) {
  unisim::testing::ScriptedPredictor predictor;
  unisim_config config;
  PoseAges found;
  if (unisim_config_init(&config, sizeof config) != UNISIM_OK) return found;
  config.window_submaps = 4;
  config.window_size = 8;
  unisim::pipeline::Options options;
  options.live = true;
  options.every_frame = true;
  options.keyframes.stride = 5;
  config.max_keyframes = 256;
  Ages ages(poses);
  unisim::pipeline::Pipeline pipeline(options, camera, predictor.table(), config, {&ages},
                                      &ages.enough);
  pipeline.run();
  std::sort(ages.ms.begin(), ages.ms.end());
  found.poses = static_cast<int>(ages.ms.size());
  found.p50_ms = percentile(ages.ms, 0.5);
  found.p95_ms = percentile(ages.ms, 0.95);
  found.in_order = ages.in_order;
  return found;
}
