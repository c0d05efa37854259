// SPDX-License-Identifier: MIT
// How long the units of a session's segments are.
#include "drivers/pipeline/metre_book.hpp"

#include <cmath>

namespace unisim::pipeline {

bool differs(const Metre& now, const Metre& before) {
  constexpr double kWorthTelling = 0.25;  // of the standard deviation
  if (!(now.per_unit > 0.0 && before.per_unit > 0.0)) return now.per_unit != before.per_unit;
  return std::abs(std::log(now.per_unit / before.per_unit)) > kWorthTelling * now.sigma;
}

void MetreBook::refresh() {
  known_.clear();
  unisim_session_info info;
  unisim_pose pose;
  const bool posed = session_->get_info(&info) == UNISIM_OK && info.last_posed >= 0 &&
                     session_->get_pose(info.last_posed, &pose) == UNISIM_OK;
  if (posed) of(pose.segment);
}

Metre MetreBook::of(int32_t segment) {
  for (const Known& known : known_) {
    if (known.segment == segment) return known.metre;
  }
  unisim_scale scale{};
  Metre metre;
  if (segment >= 0 && session_->get_scale(segment, &scale) == UNISIM_OK) {
    metre = {scale.metres_per_unit, scale.sigma};
  }
  known_.push_back({segment, metre});
  return metre;
}

}  // namespace unisim::pipeline
