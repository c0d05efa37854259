// SPDX-License-Identifier: MIT
// What the page of a live run shows, as the tracking hands it over: of bounded size.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/image.h"
#include "drivers/pipeline/listener.hpp"
#include "drivers/predictor.h"
#include "unisim/unisim.h"

namespace unisim::live::web {

inline constexpr size_t kPathPoints = 1024;  ///< of each trajectory
inline constexpr size_t kCloudPatches = 64;  ///< submaps
inline constexpr size_t kPatchPoints = 128;  ///< of each submap
inline constexpr size_t kMessages = 8;

/// A pose of a trajectory.
struct PathPoint {
  int32_t keyframe = -1;  ///< -1: between keyframes
  int32_t segment = 0;
  unisim_sim3 T_world_cam{};
};

/// Points of one submap in the camera frame of a keyframe.
struct CloudPatch {
  int32_t submap = -1;
  int32_t keyframe = -1;
  int32_t segment = 0;
  unisim_sim3 T_world_points{};
  size_t count = 0;
  std::array<float, 3 * kPatchPoints> xyz{};
};

struct StageFigures {
  const char* name = "";
  int64_t count = 0;
  double p50_ms = 0.0;
  double p95_ms = 0.0;
  double max_ms = 0.0;
};

/// One moment of the run.
struct View {
  pipeline::Progress progress;
  unisim_session_info session{};
  int32_t confidence = 0;  ///< of the newest posed keyframe
  int32_t segment = -1;    ///< of it
  double frames_per_second = 0.0;
  double age_p50_ms = 0.0;  ///< of the poses when they are given out
  double age_p95_ms = 0.0;
  double age_p99_ms = 0.0;
  std::vector<StageFigures> stages;
  std::vector<std::string> messages;  ///< the newest last

  bool has_image = false;
  unisim_image image{};  ///< of `pixels`
  std::vector<uint8_t> pixels;
  std::vector<unisim_feature> features;
  bool posed = false;  ///< the frame of `image` has a pose
  unisim_sim3 T_world_cam{};

  bool has_map = false;
  std::vector<PathPoint> live;
  std::vector<PathPoint> corrected;
  std::vector<CloudPatch> cloud;
};

}  // namespace unisim::live::web
