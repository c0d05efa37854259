// SPDX-License-Identifier: MIT
// Where in the map single frames were taken.
#include "drivers/geometric/places/locator.hpp"

#include <limits>

#include "drivers/geometric/bundle/world_move.hpp"

namespace unisim::geometric {

bool Locator::run(const State& state, const PatchStore& patches, const unisim_image& image,
                  Places* places, PlaceFound* out, bool* followed) {
  preparation_.run(image, &current_);
  const Places::Look look = {state, preparation_.gray(), current_, patches, -1};
  *followed = false;
  if (segment_ >= 0) {
    const int32_t keyframe = nearest_keyframe(state);
    *followed = keyframe >= 0 && places->look_near(look, keyframe, expected_, out);
  }
  if (!*followed && !places->locate(look, out)) {
    segment_ = -1;
    moving_ = false;
    return false;
  }
  note(state, *out);
  return true;
}

/// The keyframe whose view is most like the expected one.
int32_t Locator::nearest_keyframe(const State& state) const {
  const double unit = state.median_depth > 0 ? state.median_depth : 1;
  int32_t nearest = -1;
  double least = std::numeric_limits<double>::infinity();
  for (const int32_t k : state.map.ids()) {
    const Keyframe& held = state.map.keyframe(k);
    if (!held.posed || held.segment != segment_) continue;
    const double apart = (held.pose.center() - expected_.center()).norm() / unit +
                         angle_between(held.pose.R, expected_.R);
    if (apart >= least) continue;
    least = apart;
    nearest = k;
  }
  return nearest;
}

void Locator::note(const State& state, const PlaceFound& found) {
  const int32_t segment = state.map.keyframe(found.keyframe).segment;
  const bool goes_on = moving_ && segment == segment_;
  expected_ = found.pose;
  if (goes_on) {
    const Eigen::Matrix3d turn = found.pose.R * last_.R.transpose();
    expected_.R = turn * found.pose.R;
    expected_.t = turn * found.pose.t + (found.pose.t - turn * last_.t);
  }
  segment_ = segment;
  last_ = found.pose;
  moving_ = true;
}

}  // namespace unisim::geometric
