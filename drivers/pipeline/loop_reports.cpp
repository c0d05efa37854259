// SPDX-License-Identifier: MIT
// What became of each old keyframe that was looked at for a loop.
#include "drivers/pipeline/loop_reports.hpp"

#include <algorithm>

namespace unisim::pipeline {
namespace {

constexpr size_t kMost = 1024;

}  // namespace

LoopReports::LoopReports() { reports_.reserve(kMost); }

void LoopReports::add(const unisim_place_report& report) {
  if (reports_.size() == kMost) reports_.erase(reports_.begin(), reports_.begin() + kMost / 2);
  reports_.push_back(report);
  ++tried_;
}

void LoopReports::decide(int32_t keyframe, int32_t candidate, bool accepted, const char* reason) {
  const auto of_both = [&](const unisim_place_report& report) {
    return report.keyframe == keyframe && report.candidate == candidate;
  };
  const auto found = std::find_if(reports_.rbegin(), reports_.rend(), of_both);
  if (found == reports_.rend()) return;
  found->accepted = accepted ? 1 : 0;
  found->reason = reason;
}

void LoopReports::info(unisim_predictor_info* out) const {
  out->places = reports_.data();
  out->place_count = static_cast<int32_t>(reports_.size());
  out->loops_tried = tried_;
  out->loops_accepted = loops_;
}

}  // namespace unisim::pipeline
