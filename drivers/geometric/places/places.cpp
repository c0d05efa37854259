// SPDX-License-Identifier: MIT
// What the mapper has to do with places.
#include "drivers/geometric/places/places.hpp"

#include <limits>

namespace unisim::geometric {

namespace {
// While nothing can be followed there is time: after 60 black frames in redkitchen the right place
// was among the first 4 for seven of ten keyframes.
constexpr int32_t kLostTries = 8;
// Of a frame that is asked for by itself; while nothing is found the next frame tries the next
// ones.
constexpr int32_t kLocateTries = 12;
// A segment that could be joined stays so for as long as the camera is near it.
constexpr int32_t kJoinTries = 4;
// Every second keyframe is a place, is looked for among the older ones, and costs the time for it;
// the others describe their landmarks. One in between is looked for to confirm a loop.
constexpr int32_t kEvery = 2;
}  // namespace

Places::Places(const unisim_geometric_config& config, size_t tracks, PatchAtlas* atlas)
    : config_(config), finder_(config, atlas), store_(config.max_landmarks, tracks) {}

bool Places::relocalise(const Look& look, PlaceFound* out) {
  if (config_.places == 0) return false;
  finder_.see(look.gray, look.keyframe);
  const PlaceFinder::Question question = {PlaceFinder::Scope::kAll, 1, kLostTries};
  const bool found =
      finder_.find(look.state, store_, look.patches, look.current, question, out, &reports_);
  relocalised_ += found ? 1 : 0;
  return found;
}

bool Places::locate(const Look& look, PlaceFound* out) {
  if (config_.places == 0) return false;
  finder_.see(look.gray, look.keyframe);
  const PlaceFinder::Question question = {PlaceFinder::Scope::kAll, 0, kLocateTries};
  bool end = false;
  const bool found = finder_.find_quickly(look.state, store_, look.patches, look.current, question,
                                          skip_, out, &end);
  skip_ = found || end ? 0 : skip_ + kLocateTries;
  return found;
}

bool Places::look_near(const Look& look, int32_t keyframe, const CameraPose& expected,
                       PlaceFound* out) {
  return finder_.look_near(look.state, store_, look.patches, look.current, keyframe, expected, out);
}

void Places::keep(const Look& look) {
  if (config_.places == 0) return;
  drop_unconfirmed(look.state, look.keyframe);
  const bool seen = finder_.seen(look.keyframe);
  const bool place = look.keyframe % kEvery == 0;
  if (!place) store_.see(look.state, look.gray, look.keyframe, &finder_.orb());
  const bool loop = place || loops_.hoping();
  const bool bridge = look.state.other_segments() && (place || bridges_.hoping());
  if (!loop && !bridge) return;
  if (!seen) finder_.see(look.gray, look.keyframe);
  if (loop && !seen) try_loop(look);
  if (bridge) try_bridge(look);
  if (place) finder_.add(look.state);
}

void Places::try_loop(const Look& look) {
  if (config_.loop_tries == 0) return;
  const PlaceFinder::Question question = {PlaceFinder::Scope::kSegment, config_.loop_gap,
                                          config_.loop_tries};
  const bool found =
      finder_.find(look.state, store_, look.patches, look.current, question, &found_, &reports_);
  if (!found) return;
  loops_.add(look.state, look.keyframe, found_);
  reports_.count_loops(1);
}

void Places::try_bridge(const Look& look) {
  const PlaceFinder::Question question = {PlaceFinder::Scope::kOtherSegments, 1, kJoinTries};
  if (finder_.find(look.state, store_, look.patches, look.current, question, &found_, &reports_)) {
    bridges_.add(look.state, look.keyframe, found_);
  }
}

bool Places::take_join(const State& state, SegmentJoin* out,
                       std::vector<LoopObservation>* observations) {
  if (!bridges_.take(state, out, observations)) return false;
  ++joined_;
  return true;
}

void Places::drop_unconfirmed(const State& state, int32_t newest) {
  for (const int32_t keyframe : loops_.drop_unconfirmed(newest)) {
    reports_.count_loops(-1);
    withdraw(keyframe, UNISIM_PLACE_LOOP);
  }
  for (const int32_t keyframe : bridges_.drop_old(state, newest)) {
    withdraw(keyframe, UNISIM_PLACE_JOIN);
  }
}

void Places::withdraw(int32_t keyframe, int32_t asked) {
  const auto accepted = [&](const unisim_place_report& report) {
    return report.keyframe == keyframe && report.asked == asked && report.accepted != 0;
  };
  reports_.decide(accepted, false, "no other keyframe said the same");
}

void Places::finish(const State& state) {
  drop_unconfirmed(state, std::numeric_limits<int32_t>::max());
}

void Places::info(unisim_predictor_info* out) const {
  reports_.info(out);
  out->relocalised = relocalised_;
  out->joined = joined_;
}

int64_t Places::bytes() const {
  return finder_.bytes() + store_.bytes() + loops_.bytes() + bridges_.bytes() + reports_.bytes();
}

}  // namespace unisim::geometric
