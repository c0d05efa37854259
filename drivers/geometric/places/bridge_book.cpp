// SPDX-License-Identifier: MIT
// Keyframes found in another segment of the map, until enough of them say how the two lie.
#include "drivers/geometric/places/bridge_book.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/common/median.hpp"
#include "drivers/geometric/places/loop_book.hpp"

namespace unisim::geometric {

namespace {

// As many that agree join two segments: a false join cannot be undone. They come from one visit.
constexpr int kEnough = 3;
constexpr int32_t kWithin = 20;  // keyframes
// A young segment bends, and a pose from 20 patches in one corner of the image is off by 5 degrees
// (redkitchen after a blackout, a jump and a fast turn). Three wrong ones do not agree by chance.
constexpr double kAgreeDistance = 0.12;  // of the median depth
constexpr double kAgreeAngle = 0.1;      // rad
constexpr double kAgreeScale = 0.2;      // log
// A landmark of the present segment this near to a match is at the same depth, as a rule.
constexpr float kNear = 6.0F;  // pixels at the reference diagonal
constexpr size_t kMinRatios = 8;

/// Depth of the placed landmark that keyframe `id` sees nearest to `at`; 0: none within `reach`.
double depth_near(const State& state, int32_t id, const cv::Point2f& at, float reach) {
  const Keyframe& from = state.map.keyframe(id);
  float nearest = reach * reach;
  double depth = 0;
  for (int32_t i = 0; i < from.observations; ++i) {
    const Observation& seen = state.map.observation(id, i);
    if (seen.landmark < 0 || seen.outlier) continue;
    const Landmark& mark = state.map.landmark(seen.landmark);
    if (mark.state != LandmarkState::kPlaced || mark.soft || mark.segment != from.segment) continue;
    const cv::Point2f off = cv::Point2f(seen.x, seen.y) - at;
    if (off.dot(off) >= nearest) continue;
    nearest = off.dot(off);
    depth = from.pose.apply(mark.position).z();
  }
  return depth;
}

}  // namespace

BridgeBook::BridgeBook() {
  dropped_.reserve(bridges_.size());
  ratios_.reserve(kMostLoopMatches);
  for (Bridge& bridge : bridges_) bridge.matches.reserve(kMostLoopMatches);
}

void BridgeBook::add(const State& state, int32_t id, const PlaceFound& found) {
  Bridge& bridge = bridges_[next_++ % bridges_.size()];
  bridge.keyframe = id;
  bridge.segment = state.segment;
  bridge.other = state.map.keyframe(found.keyframe).segment;
  bridge.found = found.pose;
  keep_matches(found, &bridge.matches);
}

bool BridgeBook::hoping() const {
  return std::any_of(bridges_.begin(), bridges_.end(),
                     [](const Bridge& bridge) { return bridge.other >= 0; });
}

const std::vector<int32_t>& BridgeBook::drop_old(const State& state, int32_t newest) {
  dropped_.clear();
  for (Bridge& bridge : bridges_) {
    if (bridge.other < 0) continue;
    if (newest - bridge.keyframe <= kWithin && bridge.segment == state.segment) continue;
    bridge.other = -1;
    dropped_.push_back(bridge.keyframe);
  }
  return dropped_;
}

/// The scale from depths: one keyframe shows it, where camera centres would need a baseline.
bool BridgeBook::measure(const State& state, Bridge* bridge) {
  if (!state.map.holds(bridge->keyframe)) return false;
  ratios_.clear();
  const float reach = kNear * static_cast<float>(state.pixel_scale);
  for (const PatchMatch& match : bridge->matches) {
    const Landmark& mark = state.map.landmark(match.landmark);
    if (mark.generation != match.generation || mark.state != LandmarkState::kPlaced) continue;
    if (mark.segment != bridge->other) continue;
    const double there = bridge->found.apply(mark.position).z();
    const double here = depth_near(state, bridge->keyframe, match.point, reach);
    if (there > kMinDepth && here > kMinDepth) ratios_.push_back(std::log(here / there));
  }
  if (ratios_.size() < kMinRatios) return false;
  bridge->log_scale = drivers::median(&ratios_);
  bridge->move = WorldMove::between(bridge->found, state.map.keyframe(bridge->keyframe).pose,
                                    std::exp(bridge->log_scale));
  return true;
}

bool BridgeBook::agree(const State& state, const Bridge& a, const Bridge& b) const {
  if (a.other != b.other || std::abs(a.log_scale - b.log_scale) > kAgreeScale) return false;
  const Eigen::Vector3d off = a.move.apply(b.found.center()) - b.move.apply(b.found.center());
  return off.norm() < kAgreeDistance * state.median_depth &&
         angle_between(a.move.R, b.move.R) < kAgreeAngle;
}

/// Over all that agree with one: the scale is their median, which single keyframes are 10 % off.
WorldMove BridgeBook::mean_move(const State& state, const Bridge& of) const {
  std::vector<double> scales;
  Eigen::Vector4d turn = Eigen::Vector4d::Zero();
  const Eigen::Quaterniond first(of.move.R);
  for (const Bridge& bridge : bridges_) {
    if (bridge.other < 0 || !agree(state, of, bridge)) continue;
    scales.push_back(bridge.log_scale);
    const Eigen::Quaterniond q(bridge.move.R);
    turn += q.dot(first) < 0 ? Eigen::Vector4d(-q.coeffs()) : q.coeffs();
  }
  WorldMove out;
  out.scale = std::exp(drivers::median(&scales));
  out.R = Eigen::Quaterniond(turn.normalized()).toRotationMatrix();
  for (const Bridge& bridge : bridges_) {
    if (bridge.other < 0 || !agree(state, of, bridge)) continue;
    const Eigen::Vector3d here = state.map.keyframe(bridge.keyframe).pose.center();
    out.t +=
        (here - out.scale * (out.R * bridge.found.center())) / static_cast<double>(scales.size());
  }
  return out;
}

bool BridgeBook::take(const State& state, SegmentJoin* out,
                      std::vector<LoopObservation>* observations) {
  int waiting = 0;
  for (Bridge& bridge : bridges_) {
    if (bridge.other >= 0 && !measure(state, &bridge)) bridge.other = -1;
    waiting += bridge.other >= 0 ? 1 : 0;
  }
  if (waiting < kEnough) return false;
  for (const Bridge& of : bridges_) {
    if (of.other < 0) continue;
    const auto with = [&](const Bridge& bridge) {
      return bridge.other >= 0 && agree(state, of, bridge);
    };
    if (std::count_if(bridges_.begin(), bridges_.end(), with) < kEnough) continue;
    out->segment = of.other;
    out->move = mean_move(state, of);
    observations->clear();
    for (const Bridge& bridge : bridges_) {
      if (with(bridge)) append_observations(state, bridge.keyframe, bridge.matches, observations);
    }
    sort_by_landmark(observations);
    for (Bridge& bridge : bridges_) bridge.other = -1;
    return true;
  }
  return false;
}

int64_t BridgeBook::bytes() const {
  return static_cast<int64_t>(sizeof(*this) +
                              bridges_.size() * kMostLoopMatches * sizeof(PatchMatch));
}

}  // namespace unisim::geometric
