// SPDX-License-Identifier: MIT
// What became of each old keyframe that another one was compared with.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "drivers/predictor.h"

namespace unisim::drivers {

/// The newest thousand, and counts of all.
class PlaceReports {
 public:
  PlaceReports() { reports_.reserve(kMost); }

  void add(const unisim_place_report& report) {
    if (reports_.size() == kMost) {
      reports_.erase(reports_.begin(), reports_.begin() + kMost / 2);
      past_ += kMost / 2;
    }
    reports_.push_back(report);
    tried_ += report.asked == UNISIM_PLACE_LOOP ? 1 : 0;
  }

  /// The verdict on the newest of the comparisons that are meant, told later.
  /// @param meant  bool(const unisim_place_report&)
  /// @param reason static text
  template <typename Meant>
  void decide(Meant meant, bool accepted, const char* reason) {
    const auto found = std::find_if(reports_.rbegin(), reports_.rend(), meant);
    if (found == reports_.rend()) return;
    found->accepted = accepted ? 1 : 0;
    found->reason = reason;
  }

  /// Loops that count; one that was counted may turn out to be none.
  void count_loops(int32_t more) { loops_ += more; }

  /// Fills the fields on places and loops.
  void info(unisim_predictor_info* out) const {
    out->places = reports_.data();
    out->place_count = static_cast<int32_t>(reports_.size());
    out->places_past = past_;
    out->loops_tried = tried_;
    out->loops_accepted = loops_;
  }
  int64_t bytes() const {
    return static_cast<int64_t>(reports_.capacity() * sizeof(unisim_place_report));
  }

 private:
  static constexpr size_t kMost = 1024;
  std::vector<unisim_place_report> reports_;
  int32_t past_ = 0;
  int32_t tried_ = 0;
  int32_t loops_ = 0;
};

}  // namespace unisim::drivers
