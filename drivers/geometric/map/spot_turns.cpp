// SPDX-License-Identifier: MIT
// Turns on the spot, after which the size of all that is seen is a guess.
#include "drivers/geometric/map/spot_turns.hpp"

#include <algorithm>

#include "drivers/geometric/bundle/world_move.hpp"

namespace unisim::geometric {

namespace {

constexpr double kTurnRad = 0.8;     // most of the view is another one
constexpr double kMostMoved = 0.4;   // of the median depth, meanwhile
constexpr int kFewCarriers = 5;      // landmarks measured before the turn
constexpr int kEnoughCarriers = 20;  // to say the size again

/// Newest keyframe that looks elsewhere than `now`; -1: none.
int32_t looked_elsewhere(const State& state, const Keyframe& now) {
  int32_t id = state.posed_before(now.id);
  while (id >= 0 && angle_between(state.map.keyframe(id).pose.R, now.pose.R) < kTurnRad) {
    id = state.posed_before(id);
  }
  return id;
}

bool measured(const Landmark& mark, int32_t before) {
  return mark.state == LandmarkState::kPlaced && !mark.soft && mark.measured_at <= before;
}

/// Landmarks in view that were measured up to keyframe `before`.
int carriers(const State& state, const Keyframe& now, int32_t before) {
  int count = 0;
  for (int32_t i = 0; i < now.observations; ++i) {
    const Observation& seen = state.map.observation(now.id, i);
    if (seen.landmark < 0 || seen.outlier) continue;
    count += measured(state.map.landmark(seen.landmark), before) ? 1 : 0;
  }
  return count;
}

}  // namespace

void SpotTurns::see_keyframe(const State& state, int32_t id) {
  settle(state);
  const Keyframe& now = state.map.keyframe(id);
  const int32_t before = looked_elsewhere(state, now);
  if (before < 0 || open_.size() == open_.capacity()) return;
  const double moved = (now.pose.center() - state.map.keyframe(before).pose.center()).norm();
  if (moved >= kMostMoved * state.median_depth) return;
  if (carriers(state, now, before) < kFewCarriers) open_.push_back({before, id, 0});
}

bool SpotTurns::guessed(int32_t first, int32_t last) const {
  return std::any_of(open_.begin(), open_.end(),
                     [&](const Turn& turn) { return turn.after >= first && turn.after <= last; });
}

void SpotTurns::settle(const State& state) {
  if (open_.empty()) return;
  for (Turn& turn : open_) turn.carriers = 0;
  for (int32_t slot = 0; slot < state.map.landmark_capacity(); ++slot) {
    const Landmark& mark = state.map.landmark(slot);
    if (mark.last.keyframe < open_.front().after) continue;
    for (Turn& turn : open_) {
      if (mark.last.keyframe < turn.after) break;
      turn.carriers += measured(mark, turn.before) ? 1 : 0;
    }
  }
  const auto settled = [&](const Turn& turn) {
    return !state.map.holds(turn.after) || turn.carriers >= kEnoughCarriers;
  };
  open_.erase(std::remove_if(open_.begin(), open_.end(), settled), open_.end());
}

}  // namespace unisim::geometric
