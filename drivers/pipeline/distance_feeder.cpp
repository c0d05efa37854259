// SPDX-License-Identifier: MIT
// Distances between keyframes out of odometry, for a session.
#include "drivers/pipeline/distance_feeder.hpp"

#include <cmath>

#include "drivers/pipeline/similarity.hpp"

namespace unisim::pipeline {
namespace {

// Of a way that turns more than this, the map's idea of the chord is no longer much surer than the
// wheels'.
constexpr double kLeastStraight = 0.8;
// How far off the map's idea of a chord may be, over what it is shorter than the path.
constexpr double kBendSigma = 0.2;
// A chord that is less sure than this says nothing.
constexpr double kMostSigma = 0.3;

}  // namespace

void DistanceFeeder::settle(int32_t keyframe) {
  if (options_.odometry == nullptr || next_ < 0) return;
  for (; next_ <= keyframe; ++next_) take(next_);
}

void DistanceFeeder::take(int32_t keyframe) {
  unisim_pose pose{};
  Travelled travelled;
  const bool known = session_->get_pose(keyframe, &pose) == UNISIM_OK && pose.confidence > 0 &&
                     options_.odometry->at(pose.timestamp_ns, &travelled);
  if (!known) {
    first_ = -1;
    return;
  }
  if (first_ < 0 || pose.segment != first_pose_.segment) return begin(keyframe, pose, travelled);
  map_path_ += distance(last_pose_.T_world_kf.t, pose.T_world_kf.t);
  last_pose_ = pose;
  if (keyframe - first_ < span_) return;
  add(pose, travelled);
  begin(keyframe, pose, travelled);
}

void DistanceFeeder::begin(int32_t keyframe, const unisim_pose& pose, const Travelled& travelled) {
  first_ = keyframe;
  first_pose_ = last_pose_ = pose;
  first_travelled_ = travelled;
  map_path_ = 0.0;
}

void DistanceFeeder::add(const unisim_pose& pose, const Travelled& travelled) {
  const double path = travelled.path - first_travelled_.path;
  unisim_distance chord{};
  chord.i = first_;
  chord.j = pose.keyframe_id;
  chord.source = UNISIM_METRIC_ODOMETRY;
  chord.sigma = options_.sigma * path;
  if (options_.odometry->has_positions()) {
    chord.metres = distance(first_travelled_.position.data(), travelled.position.data());
  } else {
    const double chord_on_map = distance(first_pose_.T_world_kf.t, pose.T_world_kf.t);
    const double straight = map_path_ > 0.0 ? chord_on_map / map_path_ : 0.0;
    if (straight < kLeastStraight) return;
    chord.metres = straight * path;
    chord.sigma = std::hypot(chord.sigma, kBendSigma * (1.0 - straight) * path);
  }
  if (!(chord.metres > 0.0) || !(chord.sigma < kMostSigma * chord.metres)) return;
  // A keyframe that has left meanwhile, or numbers out of range: there are more distances to come.
  static_cast<void>(session_->add_distance(chord));
}

}  // namespace unisim::pipeline
