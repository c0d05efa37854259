// SPDX-License-Identifier: MIT
// Adjusts the whole state now and then, beside tracking.
#include "drivers/geometric/map/background_adjustment.hpp"

#include <algorithm>

#include "drivers/common/median.hpp"

namespace unisim::geometric {

namespace {
constexpr double kTolerance = 1e-4;
constexpr size_t kMinRatios = 5;
constexpr size_t kSpreadViews = 16;  // of a wide window
constexpr size_t kLeastCenters = 3;  // whose precision can be told
constexpr size_t kJoinedViews = 4;   // of them, in a segment that has been joined

void append_evenly(const std::vector<int32_t>& from, size_t views, std::vector<int32_t>* out) {
  const size_t last = from.size() - 1;
  for (size_t i = 0; i < views && views > 1; ++i) {
    out->push_back(from[(i * last + (views - 1) / 2) / (views - 1)]);
  }
}

/// Do most observations of a keyframe lie within the gate?
bool fits(const State& state, const Keyframe& keyframe) {
  int32_t seen = 0;
  int32_t within = 0;
  for (int32_t i = 0; i < keyframe.observations; ++i) {
    const Observation& one = state.map.observation(keyframe.id, i);
    if (one.landmark < 0 || one.outlier) continue;
    const Landmark& mark = state.map.landmark(one.landmark);
    if (mark.state != LandmarkState::kPlaced) continue;
    ++seen;
    const double error = reprojection_error(state, one, keyframe, mark.position);
    within += error <= kInlierGate * state.pixel_scale ? 1 : 0;
  }
  return 2 * within >= seen;
}

}  // namespace

BackgroundAdjustment::BackgroundAdjustment(const BundleCapacity& capacity, const MapCapacity& map,
                                           bool threaded)
    : adjustment_(capacity, map),
      adjusted_(static_cast<size_t>(map.landmarks), 0),
      worker_([this] { work(); }, threaded) {
  keyframes_.reserve(static_cast<size_t>(map.keyframes));
  spread_.reserve(kSpreadViews);
  spread_from_.reserve(static_cast<size_t>(map.keyframes));
  ratios_.reserve(static_cast<size_t>(map.observations_per_keyframe));
}

void BackgroundAdjustment::start(const State& state, int32_t keyframe, int iterations,
                                 std::vector<LoopObservation>* loops,
                                 const std::vector<int32_t>& joined) {
  loops_.swap(*loops);
  loops->clear();
  keyframes_.clear();
  for (const int32_t k : state.map.ids()) {
    const Keyframe& from = state.map.keyframe(k);
    if (from.posed && from.segment == state.segment) keyframes_.push_back(k);
  }
  choose_spread(joined);
  adjustment_.build(state, keyframes_.data(), keyframes_.size(), loops_);
  segment_ = state.segment;
  started_at_ = keyframe;
  iterations_ = iterations;
  pending_ = true;
  worker_.start();
}

void BackgroundAdjustment::choose_spread(const std::vector<int32_t>& joined) {
  spread_.clear();
  spread_from_.clear();
  for (const int32_t id : joined) {
    if (std::binary_search(keyframes_.begin(), keyframes_.end(), id)) spread_from_.push_back(id);
  }
  append_evenly(spread_from_, std::min(kJoinedViews, spread_from_.size()), &spread_);
  append_evenly(keyframes_, std::min(kSpreadViews, keyframes_.size()) - spread_.size(), &spread_);
  std::sort(spread_.begin(), spread_.end());
  spread_.erase(std::unique(spread_.begin(), spread_.end()), spread_.end());
}

void BackgroundAdjustment::work() {
  const BundleResult result = adjustment_.solve(iterations_, kTolerance);
  usable_ = result.status == BundleStatus::kConverged ||
            result.status == BundleStatus::kIterationCap ||
            result.status == BundleStatus::kNoDescent;
  const size_t views = spread_.size() < kLeastCenters ? 0 : spread_.size();
  const BundlePrecision precision = adjustment_.precision(spread_.data(), views);
  log_focal_sigma_ = precision.valid ? precision.log_focal_reach : 0;
  spread_sigma_ = precision.valid ? precision.center_sigma : 0;
}

WorldMove BackgroundAdjustment::move_of_newest(const State& state) {
  const int32_t newest = keyframes_.back();
  const CameraPose& now = state.map.keyframe(newest).pose;
  const CameraPose& better =
      adjustment_.problem().camera(static_cast<int>(adjustment_.cameras()) - 1).pose;
  ratios_.clear();
  for (size_t p = 0; p < adjustment_.points(); ++p) {
    const Landmark& mark = state.map.landmark(adjustment_.landmark_of(p));
    if (mark.generation != adjustment_.generation_of(p)) continue;
    if (mark.state != LandmarkState::kPlaced || mark.soft) continue;
    if (mark.last.keyframe < newest) continue;
    const double depth = now.apply(mark.position).z();
    const double depth_better =
        better.apply(adjustment_.problem().point(static_cast<int>(p)).position).z();
    if (depth > kMinDepth && depth_better > kMinDepth) ratios_.push_back(depth_better / depth);
  }
  return WorldMove::between(now, better,
                            ratios_.size() >= kMinRatios ? drivers::median(&ratios_) : 1);
}

void BackgroundAdjustment::move_rest(const WorldMove& move, State* state) {
  const std::vector<int32_t>& ids = state->map.ids();
  for (auto k = std::upper_bound(ids.begin(), ids.end(), keyframes_.back()); k != ids.end(); ++k) {
    Keyframe& later = state->map.keyframe(*k);
    if (!later.posed) continue;
    later.pose = move.apply(later.pose);
  }
  std::fill(adjusted_.begin(), adjusted_.end(), uint8_t{0});
  for (size_t p = 0; p < adjustment_.points(); ++p) {
    const auto slot = static_cast<size_t>(adjustment_.landmark_of(p));
    const Landmark& mark = state->map.landmark(adjustment_.landmark_of(p));
    adjusted_[slot] = mark.generation == adjustment_.generation_of(p) ? 1 : 0;
  }
  for (int32_t slot = 0; slot < state->map.landmark_capacity(); ++slot) {
    Landmark& mark = state->map.landmark(slot);
    if (mark.state != LandmarkState::kPlaced || mark.segment != segment_) continue;
    if (adjusted_[static_cast<size_t>(slot)]) continue;
    mark.position = move.apply(mark.position);
  }
  state->median_depth *= move.scale;
}

void BackgroundAdjustment::take(State* state) {
  for (size_t c = 0; c < adjustment_.cameras(); ++c) {
    const int32_t id = adjustment_.keyframe_of(c);
    if (!state->map.holds(id)) continue;
    state->map.keyframe(id).pose = adjustment_.problem().camera(static_cast<int>(c)).pose;
  }
  for (size_t p = 0; p < adjustment_.points(); ++p) {
    Landmark& mark = state->map.landmark(adjustment_.landmark_of(p));
    if (mark.generation != adjustment_.generation_of(p)) continue;
    mark.position = adjustment_.problem().point(static_cast<int>(p)).position;
  }
  state->intrinsics.take(adjustment_.problem().intrinsics, state->size);
  state->intrinsics.log_focal_sigma = log_focal_sigma_;
}

void BackgroundAdjustment::take_loops(State* state) {
  for (const LoopObservation& seen : loops_) {
    const Landmark& mark = state->map.landmark(seen.landmark);
    if (mark.generation != seen.generation || mark.state != LandmarkState::kPlaced) continue;
    if (!state->map.holds(seen.keyframe)) continue;
    static_cast<void>(state->map.observe_in(seen.keyframe, seen.landmark, seen.point));
  }
}

/// A keyframe that moved along no longer fits where the camera model has changed. Its observations
/// would be culled, and without them it would hold its neighbours no more.
void BackgroundAdjustment::pose_later(State* state, KeyframePose* poses) const {
  const std::vector<int32_t>& ids = state->map.ids();
  for (auto k = std::upper_bound(ids.begin(), ids.end(), keyframes_.back()); k != ids.end(); ++k) {
    Keyframe& later = state->map.keyframe(*k);
    if (!later.posed || later.segment != state->segment || fits(*state, later)) continue;
    const FramePose found = poses->solve_old(*state, *k, later.pose);
    if (!found.good) continue;
    later.pose = found.pose;
    mark_outliers(state, *k, 2 * kInlierGate);
  }
}

bool BackgroundAdjustment::merge(State* state, KeyframePose* poses) {
  pending_ = false;
  worker_.wait();
  if (!usable_ || segment_ != state->segment || keyframes_.empty()) return false;
  if (!state->map.holds(keyframes_.back())) return false;
  move_rest(move_of_newest(*state), state);
  take(state);
  take_loops(state);
  pose_later(state, poses);
  std::vector<int32_t>& all = keyframes_;
  all.clear();
  for (const int32_t k : state->map.ids()) {
    const Keyframe& from = state->map.keyframe(k);
    if (from.posed && from.segment == state->segment) all.push_back(k);
  }
  cull(state, all.data(), all.size(), kInlierGate);
  return true;
}

}  // namespace unisim::geometric
