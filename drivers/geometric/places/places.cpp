// SPDX-License-Identifier: MIT
// What the mapper has to do with places.
#include "drivers/geometric/places/places.hpp"

#include <algorithm>
#include <limits>

namespace unisim::geometric {

namespace {
// While nothing can be followed there is time: after 60 black frames in redkitchen the right place
// was among the first 4 for seven of ten keyframes.
constexpr int32_t kLostTries = 8;
// Every second keyframe is a place, is looked for among the older ones, and costs the time for it;
// the others describe their landmarks. One in between is looked for to confirm a loop.
constexpr int32_t kEvery = 2;
constexpr size_t kMostReports = 1024;
}  // namespace

Places::Places(const unisim_geometric_config& config, size_t tracks)
    : config_(config), finder_(config), store_(config.max_landmarks, tracks) {
  tried_.reserve(static_cast<size_t>(std::max(config.loop_tries, kLostTries)));
  reports_.reserve(kMostReports);
}

bool Places::relocalise(const Look& look, PlaceFound* out) {
  if (config_.places == 0) return false;
  finder_.see(look.gray, look.keyframe);
  const bool found = finder_.find(look.state, store_, look.patches, look.current,
                                  {1, kLostTries, true}, out, &tried_);
  relocalised_ += found ? 1 : 0;
  note_tried();
  return found;
}

void Places::keep(const Look& look) {
  if (config_.places == 0) return;
  drop_unconfirmed(look.keyframe);
  const bool found = finder_.seen(look.keyframe);
  const bool place = look.keyframe % kEvery == 0;
  if (!place) store_.see(look.state, look.gray, look.keyframe, &finder_.orb());
  if (!place && !loops_.hoping()) return;
  if (!found) {
    finder_.see(look.gray, look.keyframe);
    try_loop(look);
  }
  if (place) finder_.add(look.state);
}

void Places::try_loop(const Look& look) {
  if (config_.loop_tries == 0) return;
  const PlaceFinder::Question question = {config_.loop_gap, config_.loop_tries, false};
  const bool found =
      finder_.find(look.state, store_, look.patches, look.current, question, &found_, &tried_);
  if (found) loops_.add(look.state, look.keyframe, found_);
  loops_tried_ += static_cast<int32_t>(tried_.size());
  loops_accepted_ += found ? 1 : 0;
  note_tried();
}

void Places::drop_unconfirmed(int32_t newest) {
  for (const int32_t keyframe : loops_.drop_unconfirmed(newest)) {
    --loops_accepted_;
    for (unisim_place_report& report : reports_) {
      if (report.keyframe != keyframe || report.lost != 0 || report.accepted == 0) continue;
      report.accepted = 0;
      report.reason = "no other keyframe said the same";
    }
  }
}

void Places::note_tried() {
  if (reports_.size() + tried_.size() > kMostReports) {
    reports_.erase(reports_.begin(), reports_.begin() + kMostReports / 2);
  }
  reports_.insert(reports_.end(), tried_.begin(), tried_.end());
  tried_.clear();
}

void Places::finish() { drop_unconfirmed(std::numeric_limits<int32_t>::max()); }

void Places::info(unisim_predictor_info* out) const {
  out->places = reports_.data();
  out->place_count = static_cast<int32_t>(reports_.size());
  out->loops_tried = loops_tried_;
  out->loops_accepted = loops_accepted_;
  out->relocalised = relocalised_;
}

int64_t Places::bytes() const {
  return finder_.bytes() + store_.bytes() + loops_.bytes() +
         static_cast<int64_t>(reports_.capacity() * sizeof(unisim_place_report));
}

}  // namespace unisim::geometric
