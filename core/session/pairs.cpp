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

}  // namespace

double Session::quality_multiplier(double center_sigma) const {
  if (center_sigma <= config_.sigma_reference) return 1.0;
  const double ratio = config_.sigma_reference / center_sigma;
  return std::max(ratio * ratio, kLeastMultiplier);
}

EdgeWeight Session::edge_weight(FactorKind kind, double multiplier, EdgeOrigin origin) const {
  const RobustKernel kernel =
      origin == EdgeOrigin::kLoop
          ? RobustKernel{RobustKernelKind::kGemanMcClure, config_.loop_delta}
          : RobustKernel{RobustKernelKind::kHuber, config_.huber_delta};
  return {config_.factor(kind).information, multiplier, kernel, origin};
}

Status Session::add_keyframe(int64_t timestamp_ns, int32_t* id) {
  const int32_t newest = keyframes_.size() - 1;
  if (newest >= config_.first_keyframe_id && timestamp_ns <= keyframes_[newest].timestamp_ns) {
    return Status::kInvalidArgument;
  }
  if ((keyframes_.full() && !slides()) || !has_ids()) return Status::kCapacity;
  if (slides()) make_keyframe_room();
  *id = keyframes_.append(timestamp_ns);
  depth_.begin_keyframe(*id);
  if (slides() && keyframes_.first() > live_from_) {
    live_from_ = keyframes_.first();
    drop_windows_before(live_from_);
  }
  Window skipped;
  if (!windows_.keyframe_added(keyframes_.size(), &skipped)) {
    refuse_window(skipped, RefusalReason::kRoom);
  }
  return broken_ ? Status::kInternal : Status::kOk;
}

Status Session::add_two_view(const TwoViewInput& input) {
  if (input.i < 0 || input.j != input.i + 1) return Status::kInvalidArgument;
  if (input.j >= keyframes_.size()) return Status::kNotReady;
  if (input.j <= settled_) return Status::kInvalidArgument;
  if (input.j != settled_ + 1) return Status::kNotReady;

  depth_.sample(input.depth_i, &sampled_);
  double log_ratio = 0.0;
  double multiplier = quality_multiplier(input.center_sigma);
  if (keyframes_[input.i].node >= 0) {
    LogMedianRatio ratio = {};
    if (depth_.over_two_view(sampled_, input.i, &ratio)) {
      log_ratio = -ratio.log_ratio;
      if (input.center_sigma == 0.0 && ratio.scatter > config_.scatter_gate) {
        refuse_pair(input.j, RefusalReason::kScatter, ratio.scatter, config_.scatter_gate);
        return Status::kOk;
      }
    } else {
      multiplier *= kUnknownRatioMultiplier;
      LogLine line;
      line << "pair " << input.i << "," << input.j
           << ": no depth in common with the pair before, its length is a guess";
      line.send(config_.log, LogLevel::kWarning);
    }
  }
  // Depth that leaps by many orders of magnitude, again and again, leaves the range of numbers.
  const int32_t source = keyframes_.pose_source(input.i);
  const Sim3 T_world_i = source >= 0 ? keyframe_pose(source) : Sim3();
  const Sim3 Z_i_j = two_view_measurement(input.T_i_j, math::exp(log_ratio));
  const bool in_range =
      Z_i_j.in_range() && (T_world_i * Z_i_j).in_range() && (T_world_i * input.T_i_j).in_range();
  if (!in_range) {
    refuse_pair(input.j, RefusalReason::kRange);
    return Status::kOk;
  }
  accept_pair(input, log_ratio, multiplier);
  make_node_room();
  return broken_ ? Status::kInternal : Status::kOk;
}

void Session::accept_pair(const TwoViewInput& input, double log_ratio, double multiplier) {
  const bool paper = config_.preset == Preset::kPaper;
  const bool starts = keyframes_[input.i].node < 0;
  if (starts) {
    const int32_t source = keyframes_.pose_source(input.i);
    start_segment(input.i, source >= 0 ? keyframe_pose(source) : Sim3());
  }
  if (starts || paper) depth_.keep_two_view(sampled_, input.i);
  const Keyframe& i = keyframes_[input.i];
  const Sim3& T_world_i = graph_.pose(i.node);
  const double live_ratio = paper ? 1.0 : math::exp(config_.live_scale_exponent * log_ratio);
  give_node(input.j, T_world_i * Sim3::scaling(live_ratio) * input.T_i_j, i.segment);
  depth_.sample(input.depth_j, &sampled_);
  depth_.keep_two_view(sampled_, input.j);
  if (broken_) return;

  if (config_.factor(FactorKind::kTwoView).enabled) {
    const Sim3 Z_i_j =
        paper ? input.T_i_j : two_view_measurement(input.T_i_j, math::exp(log_ratio));
    int32_t edge = -1;
    holds(graph_.add_two_view(i.node, keyframes_[input.j].node, Z_i_j,
                              edge_weight(FactorKind::kTwoView, multiplier, EdgeOrigin::kPair),
                              &edge));
  }
  tracking_.pair_accepted();
  if (i.state == Tracking::kInit) keyframes_[input.i].state = tracking_.state();
  keyframes_[input.j].state = tracking_.state();
  settled_ = input.j;
}

void Session::start_segment(int32_t keyframe, const Sim3& T_world_kf) {
  give_node(keyframe, T_world_kf, next_segment_);
  ++next_segment_;
  ++counts_.segments;
}

void Session::give_node(int32_t keyframe, const Sim3& T_world_kf, int32_t segment) {
  Keyframe& target = keyframes_[keyframe];
  if (!holds(graph_.add_node(NodeKind::kKeyframe, T_world_kf, &target.node))) return;
  target.held_from = -1;
  target.segment = segment;
  ++counts_.posed_keyframes;
  ++counts_.live_nodes;
  counts_.last_posed = std::max(counts_.last_posed, keyframe);
}

void Session::refuse_pair(int32_t j, RefusalReason reason, double value, double limit) {
  refusals_.add(PredictionKind::kPair, {reason, j - 1, j, value, limit});
  tracking_.pair_refused();
  Keyframe& keyframe = keyframes_[j];
  keyframe.held_from = keyframes_.has(j - 1) ? keyframes_.pose_source(j - 1) : -1;
  keyframe.state = tracking_.state();
  if (keyframe.held_from >= 0) {
    keyframe.segment = keyframes_[keyframe.held_from].segment;
    counts_.last_posed = j;
  }
  settled_ = j;
}

}  // namespace unisim
