// SPDX-License-Identifier: MIT
// Keyframes and two-view predictions: the live chain, held poses, segments.
#include <algorithm>

#include "core/base/math.hpp"
#include "core/graph/two_view.hpp"
#include "core/session.hpp"

namespace unisim {
namespace {

// A pair whose depth cannot be compared with the pair before keeps the chain together, but says
// next to nothing about its length: any submap over it decides.
constexpr double kUnknownRatioMultiplier = 0.01;
// Keeps the system well conditioned however bad a predictor calls itself.
constexpr double kLeastMultiplier = 1e-4;
// From here on nobody should act on lengths without knowing.
constexpr double kDoubtfulScale = 0.1;

}  // namespace

double Session::quality_multiplier(double sigma) const {
  if (sigma <= map_.config.sigma_reference) return 1.0;
  const double ratio = map_.config.sigma_reference / sigma;
  return std::max(ratio * ratio, kLeastMultiplier);
}

Status Session::add_keyframe(int64_t timestamp_ns, int32_t* id) {
  const int32_t newest = map_.keyframes.size() - 1;
  if (newest >= first_of_run_ && timestamp_ns <= map_.keyframes[newest].timestamp_ns) {
    return Status::kInvalidArgument;
  }
  if ((map_.keyframes.full() && !map_.config.slides()) || !has_ids()) return Status::kCapacity;
  if (map_.config.slides()) make_keyframe_room();
  *id = map_.keyframes.append(timestamp_ns);
  depth_.begin_keyframe(*id);
  refuse_late_windows();
  Window skipped;
  if (!requests_.keyframe_added(&skipped)) {
    refuse_window(skipped, RefusalReason::kRoom);
  }
  return broken() ? Status::kInternal : Status::kOk;
}

Status Session::add_two_view(const TwoViewInput& input) {
  if (input.i < 0 || input.j <= input.i) return Status::kInvalidArgument;
  if (input.j >= map_.keyframes.size()) return Status::kNotReady;
  if (input.j <= map_.keyframes.settled()) return Status::kInvalidArgument;
  if (input.j != map_.keyframes.settled() + 1) return Status::kNotReady;
  const bool over_gap = input.j != input.i + 1;
  if (over_gap) {
    const Status status = check_gap(input.i, input.j);
    if (!is_ok(status)) return status;
  }

  depth_.sample(input.depth_i, &sampled_);
  double log_ratio = 0.0;
  double multiplier = quality_multiplier(std::max(input.center_sigma, input.log_scale_sigma));
  if (map_.keyframes[input.i].node >= 0) {
    LogMedianRatio ratio = {};
    if (depth_.over_two_view(sampled_, input.i, &ratio)) {
      log_ratio = -ratio.log_ratio;
      if (input.center_sigma == 0.0 && ratio.scatter > map_.config.scatter_gate) {
        refuse_pair(input.j, RefusalReason::kScatter, ratio.scatter, map_.config.scatter_gate);
        return Status::kOk;
      }
    } else {
      multiplier *= kUnknownRatioMultiplier;
      LogLine line;
      line << "pair " << input.i << "," << input.j
           << ": no depth in common with the pair before, its length is a guess";
      line.send(map_.config.log, LogLevel::kWarning);
    }
  }
  // Depth that leaps by many orders of magnitude, again and again, leaves the range of numbers.
  const int32_t source = map_.keyframes.pose_source(input.i);
  const Sim3 T_world_i = source >= 0 ? map_.keyframe_pose(source) : Sim3();
  const Sim3 Z_i_j = two_view_measurement(input.T_i_j, math::exp(log_ratio));
  const bool in_range =
      Z_i_j.in_range() && (T_world_i * Z_i_j).in_range() && (T_world_i * input.T_i_j).in_range();
  if (!in_range) {
    refuse_pair(input.j, RefusalReason::kRange);
    return Status::kOk;
  }
  accept_pair(input, log_ratio, multiplier);
  if (over_gap) {
    tracking_.relocalised();
    map_.keyframes[input.j].state = tracking_.state();
  }
  make_node_room();
  return broken() ? Status::kInternal : Status::kOk;
}

/// A pair may leave out keyframes only where the track was lost: those have no pose, or lie in a
/// segment of their own.
Status Session::check_gap(int32_t i, int32_t j) const {
  if (map_.keyframes.gone(i) || map_.keyframes[i].retired()) return Status::kRetired;
  if (map_.keyframes[i].node < 0) return Status::kInvalidArgument;
  for (int32_t k = i + 1; k < j; ++k) {
    const bool same = map_.keyframes[k].segment == map_.keyframes[i].segment;
    if (map_.keyframes[k].posed() && same) return Status::kInvalidArgument;
  }
  return Status::kOk;
}

void Session::accept_pair(const TwoViewInput& input, double log_ratio, double multiplier) {
  const bool paper = map_.config.preset == Preset::kPaper;
  const bool starts = map_.keyframes[input.i].node < 0;
  if (starts) {
    const int32_t source = map_.keyframes.pose_source(input.i);
    start_segment(input.i, source >= 0 ? map_.keyframe_pose(source) : Sim3());
  }
  if (starts || paper) depth_.keep_two_view(sampled_, input.i);
  const Keyframe& i = map_.keyframes[input.i];
  const Sim3& T_world_i = map_.graph.pose(i.node);
  const double live_ratio = paper ? 1.0 : math::exp(map_.config.live_scale_exponent * log_ratio);
  give_node(input.j, T_world_i * Sim3::scaling(live_ratio) * input.T_i_j, i.segment);
  depth_.sample(input.depth_j, &sampled_);
  depth_.keep_two_view(sampled_, input.j);
  if (broken()) return;

  if (map_.config.factor(FactorKind::kTwoView).enabled) {
    const Sim3 Z_i_j =
        paper ? input.T_i_j : two_view_measurement(input.T_i_j, math::exp(log_ratio));
    int32_t edge = -1;
    holds(map_.graph.add_two_view(
        i.node, map_.keyframes[input.j].node, Z_i_j,
        map_.config.edge_weight(FactorKind::kTwoView, multiplier, EdgeOrigin::kPair), &edge));
  }
  map_.keyframes[input.j].log_scale_sigma = input.log_scale_sigma;
  tracking_.pair_accepted(input.log_scale_sigma > kDoubtfulScale);
  if (i.state == Tracking::kInit) map_.keyframes[input.i].state = tracking_.state();
  map_.keyframes[input.j].state = tracking_.state();
  map_.keyframes.settle(input.j);
}

void Session::start_segment(int32_t keyframe, const Sim3& T_world_kf) {
  give_node(keyframe, T_world_kf, next_segment_);
  ++next_segment_;
  ++counts_.segments;
}

void Session::give_node(int32_t keyframe, const Sim3& T_world_kf, int32_t segment) {
  Keyframe& target = map_.keyframes[keyframe];
  if (!holds(map_.graph.add_node(NodeKind::kKeyframe, T_world_kf, &target.node))) return;
  target.held_from = -1;
  target.segment = segment;
  ++counts_.posed_keyframes;
  counts_.last_posed = std::max(counts_.last_posed, keyframe);
}

void Session::refuse_pair(int32_t j, RefusalReason reason, double value, double limit) {
  refusals_.add(PredictionKind::kPair, {reason, j - 1, j, value, limit});
  tracking_.pair_refused();
  Keyframe& keyframe = map_.keyframes[j];
  keyframe.held_from = map_.keyframes.has(j - 1) ? map_.keyframes.pose_source(j - 1) : -1;
  keyframe.state = tracking_.state();
  if (keyframe.held_from >= 0) {
    keyframe.segment = map_.keyframes[keyframe.held_from].segment;
    counts_.last_posed = j;
  }
  map_.keyframes.settle(j);
}

/// The ring is about to let go of its oldest keyframe: nothing may depend on it any more.
void Session::make_keyframe_room() {
  if (!map_.keyframes.full()) return;
  const int32_t oldest = map_.keyframes.first();
  while (map_.keyframes.settled() <= oldest) {
    refuse_pair(map_.keyframes.settled() + 1, RefusalReason::kLate);
  }
  skeleton_.let_go_through(oldest);
}

void Session::make_node_room() {
  if (!map_.config.slides()) return;
  while (!broken() && live_nodes() > live_nodes_capacity_ && skeleton_.close_stretch()) {
  }
  refuse_late_windows();
}

/// Predictions that come in another order: windows over retired keyframes are asked for no more.
void Session::refuse_late_windows() {
  Window dropped;
  while (requests_.drop_before(skeleton_.live_from(), &dropped)) {
    refuse_window(dropped, RefusalReason::kLate);
  }
}

}  // namespace unisim
