// SPDX-License-Identifier: MIT
// A run that finds no start says why while it goes on, not only at its end.
#include <algorithm>
#include <string>
#include <vector>

#include "drivers/pipeline/tracking_reason.hpp"
#include "tests/pipeline/scripted_run.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::testing;

namespace {

const char* const kWhy = "no start: all is dark";

struct Lines : Recorder {
  void on_progress(const Progress& progress) override {
    if (lines.size() > told_at.size()) told_at.push_back(progress.frames);
  }
  std::vector<int64_t> told_at;
};

}  // namespace

TEST_CASE("a run without a start says why, more and more seldom") {
  Run run(500);
  Lines lines;
  run.config.max_keyframes = 128;
  run.listeners = {&lines};
  run.predictor.pending_until = 1000;
  run.predictor.no_start = kWhy;
  CHECK(run.go().outcome == Outcome::kFinished);
  REQUIRE(lines.told_at.size() >= 2);
  CHECK(lines.told_at[0] == 100);
  CHECK(lines.told_at[1] == 400);
  CHECK(std::count(lines.lines.begin(), lines.lines.end(), kWhy) == 2);
}

TEST_CASE("a run with a pose has started") {
  Run run;
  run.predictor.no_start = kWhy;
  run.go();
  CHECK_FALSE(run.listener.told(kWhy));
}

TEST_CASE("what a start lacks is told before it and explains no loss after it") {
  TrackingReason reason;
  reason.see_frame(UNISIM_REASON_TURNED);
  CHECK(reason.of_state(UNISIM_STATE_INIT) == UNISIM_REASON_TURNED);
  reason.see_frame(UNISIM_REASON_NONE);
  CHECK(reason.of_state(UNISIM_STATE_DEGRADED) == UNISIM_REASON_PREDICTION);
}
