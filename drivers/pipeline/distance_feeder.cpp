// SPDX-License-Identifier: MIT
// Distances between keyframes out of odometry, for a session.
#include "drivers/pipeline/distance_feeder.hpp"

#include <cmath>
#include <string>

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
  take_inbox();
  if (odometry() == nullptr || next_ < 0) return;
  for (; next_ <= keyframe; ++next_) {
    unisim_pose pose{};
    const bool waits = odometry() == &live_ && session_->get_pose(next_, &pose) == UNISIM_OK &&
                       live_.ends_before(pose.timestamp_ns);
    if (waits) return;
    take(next_);
  }
}

const Odometry* DistanceFeeder::odometry() const {
  if (options_.odometry != nullptr) return options_.odometry;
  return options_.inbox != nullptr ? &live_ : nullptr;
}

void DistanceFeeder::take_inbox() {
  if (options_.inbox == nullptr) return;
  options_.inbox->take(&taken_, &options_.common_sigma);
  for (const OdometryStep& step : taken_.steps) live_.add(step);
  for (const OdometryPosition& position : taken_.positions) live_.add(position);
  for (const unisim_distance& distance : taken_.distances) pass_on(distance);
}

void DistanceFeeder::pass_on(const unisim_distance& distance) {
  const unisim_status status = session_->add_distance(distance);
  if (status == UNISIM_OK) return;
  messages_->say(MessageKind::kInvalid, "distance of keyframes " + std::to_string(distance.i) +
                                            " and " + std::to_string(distance.j) + ": " +
                                            unisim_status_string(status));
}

void DistanceFeeder::take(int32_t keyframe) {
  unisim_pose pose{};
  Travelled travelled;
  const bool known = session_->get_pose(keyframe, &pose) == UNISIM_OK && pose.confidence > 0 &&
                     odometry()->at(pose.timestamp_ns, &travelled);
  if (!known) {
    first_ = -1;
    return;
  }
  const bool apart = first_ < 0 || pose.segment != first_pose_.segment ||
                     travelled.stretch != first_travelled_.stretch;
  if (apart) return begin(keyframe, pose, travelled);
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
  chord.sigma = options_.sigma * path + travelled.sigma - first_travelled_.sigma;
  chord.common_sigma = options_.common_sigma;
  if (odometry()->has_positions()) {
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
