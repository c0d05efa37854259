// SPDX-License-Identifier: MIT
// Loops found and not yet in the map.
#include "drivers/geometric/places/loop_book.hpp"

#include <algorithm>

#include "drivers/geometric/bundle/world_move.hpp"

namespace unisim::geometric {

namespace {

// Keyframes within which a second one has to say the same.
constexpr int32_t kConfirmWithin = 5;
// Verified poses are off by 1 % of the median depth and 0.3 degrees (nine in ten, redkitchen); a
// young map bends by several times that between two keyframes' loops, a wrong place is off by more
// than 10 % or 5 degrees.
constexpr double kAgreeDistance = 0.05;  // of the median depth
constexpr double kAgreeAngle = 0.045;    // rad

}  // namespace

void keep_matches(const PlaceFound& found, std::vector<PatchMatch>* kept) {
  const auto count = std::min(found.matches.size(), kMostLoopMatches);
  kept->assign(found.matches.begin(), found.matches.begin() + static_cast<std::ptrdiff_t>(count));
}

void append_observations(const State& state, int32_t keyframe,
                         const std::vector<PatchMatch>& matches,
                         std::vector<LoopObservation>* out) {
  for (const PatchMatch& match : matches) {
    const Landmark& mark = state.map.landmark(match.landmark);
    if (mark.generation != match.generation || mark.state != LandmarkState::kPlaced) continue;
    out->push_back({match.landmark, match.generation, keyframe, match.point});
  }
}

LoopBook::LoopBook() {
  dropped_.reserve(loops_.size());
  for (Loop& loop : loops_) loop.matches.reserve(kMostLoopMatches);
}

/// The move of the state's world that puts each keyframe where it was found is the same for both.
bool LoopBook::agree(const State& state, const Loop& a, const Loop& b) {
  if (a.segment != b.segment || !state.map.holds(a.keyframe)) return false;
  const CameraPose& at_a = state.map.keyframe(a.keyframe).pose;
  const CameraPose& at_b = state.map.keyframe(b.keyframe).pose;
  const WorldMove by_a = WorldMove::between(at_a, a.found, 1);
  const WorldMove by_b = WorldMove::between(at_b, b.found, 1);
  const double off = (by_a.apply(at_b.center()) - b.found.center()).norm();
  return off < kAgreeDistance * state.median_depth && angle_between(by_a.R, by_b.R) < kAgreeAngle;
}

void LoopBook::add(const State& state, int32_t id, const PlaceFound& found) {
  Loop& loop = loops_[next_++ % loops_.size()];
  loop.keyframe = id;
  loop.segment = state.segment;
  loop.counts = false;
  loop.taken = false;
  loop.found = found.pose;
  keep_matches(found, &loop.matches);
  for (Loop& other : loops_) {
    const bool recent =
        other.keyframe >= 0 && other.keyframe < id && id - other.keyframe <= kConfirmWithin;
    if (!recent || !agree(state, other, loop)) continue;
    other.counts = true;
    loop.counts = true;
  }
}

const std::vector<int32_t>& LoopBook::drop_unconfirmed(int32_t newest) {
  dropped_.clear();
  for (Loop& loop : loops_) {
    if (loop.taken || loop.counts || newest - loop.keyframe <= kConfirmWithin) continue;
    loop.taken = true;
    dropped_.push_back(loop.keyframe);
  }
  return dropped_;
}

void LoopBook::forget(int32_t segment) {
  for (Loop& loop : loops_) loop.taken |= loop.segment == segment;
}

bool LoopBook::waiting(int32_t segment) const {
  return std::any_of(loops_.begin(), loops_.end(), [&](const Loop& loop) {
    return !loop.taken && loop.counts && loop.segment == segment;
  });
}

bool LoopBook::hoping() const {
  return std::any_of(loops_.begin(), loops_.end(),
                     [](const Loop& loop) { return !loop.taken && !loop.counts; });
}

void LoopBook::take(const State& state, std::vector<LoopObservation>* out) {
  out->clear();
  for (Loop& loop : loops_) {
    if (loop.taken || !loop.counts || loop.segment != state.segment) continue;
    loop.taken = true;
    if (!state.map.holds(loop.keyframe)) continue;
    append_observations(state, loop.keyframe, loop.matches, out);
  }
  sort_by_landmark(out);
}

int64_t LoopBook::bytes() const {
  return static_cast<int64_t>(sizeof(*this) +
                              loops_.size() * kMostLoopMatches * sizeof(PatchMatch));
}

}  // namespace unisim::geometric
