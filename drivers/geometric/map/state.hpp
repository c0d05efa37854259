// SPDX-License-Identifier: MIT
// The running state that all steps of the predictor work on.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "drivers/geometric/geometric.h"
#include "drivers/geometric/image/tracks.hpp"
#include "drivers/geometric/map/landmark_map.hpp"
#include "drivers/geometric/start/intrinsics.hpp"

namespace unisim::geometric {

/// Gates in pixels at an image diagonal of 800 (scaled by State::pixel_scale).
inline constexpr double kInlierGate = 4.0;
inline constexpr double kTriangulationGate = 2.0;
inline constexpr double kMinParallaxRad = 0.017453292519943295;  // 1 degree
/// Posed keyframes until which the whole segment is adjusted with each new keyframe.
inline constexpr int kEarlyKeyframes = 20;

/// A landmark seen again in a keyframe that closes a loop; not an observation of the map yet.
struct LoopObservation {
  int32_t landmark = -1;
  uint32_t generation = 0;
  int32_t keyframe = -1;
  cv::Point2f point;
};
/// By landmark and keyframe, as MapAdjustment::build() wants them.
void sort_by_landmark(std::vector<LoopObservation>* observations);

struct State {
  explicit State(const unisim_geometric_config& configuration, const MapCapacity& capacity)
      : config(configuration), map(capacity) {}

  unisim_geometric_config config;
  LandmarkMap map;
  Tracks tracks;
  Intrinsics intrinsics;
  cv::Size size;
  double pixel_scale = 1;   ///< image diagonal / 800
  int feature_spacing = 1;  ///< pixels between features
  double frame_step_s = 0;  ///< between the last two frames, 0: not known
  bool initialised = false;
  int32_t segment = 0;
  int32_t segment_start = 0;  ///< first keyframe of the segment
  int32_t segments = 1;       ///< ever begun; that many numbers are taken
  int32_t posed = 0;          ///< keyframes posed in this segment
  double median_depth = 0;    ///< of the newest posed keyframe's landmarks

  /// Begins a segment with keyframe `id`.
  void begin(int32_t id);
  /// Goes on in an older segment.
  void enter(int32_t older_segment);

  /// Does the map hold posed keyframes of another segment?
  bool other_segments() const;

  bool early() const { return posed <= kEarlyKeyframes; }
  /// Newest posed keyframe of the segment before `id`, -1 if none.
  int32_t posed_before(int32_t id) const { return posed_before(id, segment); }
  /// The same of any segment.
  int32_t posed_before(int32_t id, int32_t of_segment) const;
};

/// Reprojection error of an observation in undistorted pixels; infinite behind the camera.
double reprojection_error(const State& state, const Observation& seen, const Keyframe& from,
                          const Eigen::Vector3d& position);

/// Marks the newest keyframe's observations of placed landmarks that are off by more than `gate`.
void mark_outliers(State* state, int32_t keyframe, double gate);

/// After an adjustment: drops observations of the given keyframes' landmarks that are off by more
/// than `gate`; a landmark left with fewer than two loses its position.
void cull(State* state, const int32_t* keyframes, size_t count, double gate);

}  // namespace unisim::geometric
