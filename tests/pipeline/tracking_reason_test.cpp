// SPDX-License-Identifier: MIT
// Why a run stands where it stands.
#include "drivers/pipeline/tracking_reason.hpp"

#include <map>
#include <string>

#include "tests/pipeline/scripted_run.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::testing;
using unisim::pipeline::reason_name;
using unisim::pipeline::TrackingReason;

TEST_CASE("while tracking goes well the reason is the newest frame's") {
  TrackingReason reason;
  CHECK(reason.of_state(UNISIM_STATE_INIT) == UNISIM_REASON_START);
  reason.see_frame(UNISIM_REASON_BLUR);
  CHECK(reason.of_state(UNISIM_STATE_INIT) == UNISIM_REASON_BLUR);
  CHECK(reason.of_state(UNISIM_STATE_TRACKING) == UNISIM_REASON_BLUR);
  reason.see_frame(UNISIM_REASON_NONE);
  CHECK(reason.of_state(UNISIM_STATE_TRACKING) == UNISIM_REASON_NONE);
  CHECK(reason.of_state(UNISIM_STATE_RELOCALISED) == UNISIM_REASON_NONE);
}

TEST_CASE("without a track what went before it is the reason, for as long as it lasts") {
  TrackingReason reason;
  reason.see_frame(UNISIM_REASON_COVERED);
  reason.see_frame(UNISIM_REASON_NONE);
  for (int k = 0; k < 10 * TrackingReason::kMemory; ++k) {
    CHECK(reason.of_state(UNISIM_STATE_LOST) == UNISIM_REASON_COVERED);
    reason.see_frame(k == 5 ? UNISIM_REASON_DUPLICATE : UNISIM_REASON_NONE);
  }
  CHECK(reason.of_state(UNISIM_STATE_TRACKING) == UNISIM_REASON_NONE);
  CHECK(reason.of_state(UNISIM_STATE_DEGRADED) == UNISIM_REASON_PREDICTION);
}

TEST_CASE("a reason long past explains nothing") {
  TrackingReason reason;
  reason.see_frame(UNISIM_REASON_BLUR);
  for (int k = 0; k <= TrackingReason::kMemory; ++k) reason.see_frame(UNISIM_REASON_NONE);
  CHECK(reason.of_state(UNISIM_STATE_TRACKING) == UNISIM_REASON_NONE);
  CHECK(reason.of_state(UNISIM_STATE_DEGRADED) == UNISIM_REASON_PREDICTION);
}

TEST_CASE("frames are counted by reason, numbers that are none as none") {
  TrackingReason reason;
  for (const int32_t value : {UNISIM_REASON_BLUR, UNISIM_REASON_BLUR, -3, UNISIM_REASON_COUNT})
    reason.see_frame(value);
  CHECK(reason.frames()[UNISIM_REASON_BLUR] == 2);
  CHECK(reason.frames()[UNISIM_REASON_NONE] == 2);
}

TEST_CASE("every reason has a name, and no other number") {
  for (int32_t reason = 1; reason < UNISIM_REASON_COUNT; ++reason)
    CHECK(std::string(reason_name(reason)) != "");
  for (const int32_t reason : {-1, UNISIM_REASON_NONE, UNISIM_REASON_COUNT})
    CHECK(std::string(reason_name(reason)) == "");
}

namespace {

struct Reasons : unisim::pipeline::Listener {
  std::map<int64_t, std::pair<int32_t, int32_t>> at;  // frames seen: state, reason
  void on_progress(const unisim::pipeline::Progress& progress) override {
    at[progress.frames] = {progress.state, progress.reason};
  }
};

}  // namespace

TEST_CASE("a guessed scale is told as a turn on the spot, and poses go on") {
  Run run;
  Reasons reasons;
  run.predictor.guessed_pairs = {10, 12};  // keyframes 11 and 13, at frames 55 and 65
  run.predictor.rejected_pairs = {11};
  run.listeners.push_back(&reasons);
  REQUIRE(run.go().outcome == Outcome::kFinished);
  CHECK(reasons.at[56] == std::make_pair(UNISIM_STATE_DEGRADED, UNISIM_REASON_SPOT_TURN));
  CHECK(reasons.at[61] == std::make_pair(UNISIM_STATE_DEGRADED, UNISIM_REASON_PREDICTION));
  CHECK(reasons.at[71] == std::make_pair(UNISIM_STATE_TRACKING, UNISIM_REASON_NONE));
}

TEST_CASE("a run tells why its track suffers, and changes nothing by it") {
  Run plain;
  plain.predictor.rejected_pairs = {11};
  plain.go();
  Run run;
  Reasons reasons;
  run.predictor.rejected_pairs = {11};  // keyframes 11 and 12, at frames 55 and 60
  run.predictor.reasons = {{58, UNISIM_REASON_BLUR}, {130, UNISIM_REASON_DUPLICATE}};
  run.listeners.push_back(&reasons);
  const Result& result = run.go();
  REQUIRE(result.outcome == Outcome::kFinished);
  CHECK(reasons.at[58] == std::make_pair(UNISIM_STATE_TRACKING, UNISIM_REASON_NONE));
  CHECK(reasons.at[59] == std::make_pair(UNISIM_STATE_TRACKING, UNISIM_REASON_BLUR));
  CHECK(reasons.at[61] == std::make_pair(UNISIM_STATE_DEGRADED, UNISIM_REASON_BLUR));
  CHECK(reasons.at[66] == std::make_pair(UNISIM_STATE_TRACKING, UNISIM_REASON_NONE));
  CHECK(reasons.at[131] == std::make_pair(UNISIM_STATE_TRACKING, UNISIM_REASON_DUPLICATE));
  CHECK(result.frames_by_reason[UNISIM_REASON_BLUR] == 1);
  CHECK(result.frames_by_reason[UNISIM_REASON_DUPLICATE] == 1);
  REQUIRE(run.listener.live.size() == plain.listener.live.size());
  for (size_t k = 0; k < run.listener.live.size(); ++k)
    CHECK(run.listener.live[k].T_world_cam.t[0] == plain.listener.live[k].T_world_cam.t[0]);
}
