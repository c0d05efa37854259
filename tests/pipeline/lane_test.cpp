// SPDX-License-Identifier: MIT
// Windows asked for beside the tracking: a replay is the same however long they take, a realtime
// run does not wait for them.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <thread>

#include "tests/pipeline/scripted_run.hpp"

using namespace unisim::testing;
using std::chrono::milliseconds;

namespace {

/// Windows, revisions and wide windows that differ from the truth, from a predictor with two lanes.
struct ConcurrentRun : Run {
  explicit ConcurrentRun(int64_t frames = 200) : Run(frames) {
    predictor.table()->concurrent_windows = 1;
    predictor.window_noise = 0.02;
  }
  void windows_take(milliseconds time) {
    predictor.before_window = [time](int32_t) { std::this_thread::sleep_for(time); };
  }
};

bool same_bits(const unisim_sim3& a, const unisim_sim3& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

}  // namespace

TEST_CASE("a replay gives the same bits with a slow and with a fast lane") {
  ConcurrentRun fast;
  ConcurrentRun slow;
  slow.windows_take(milliseconds(30));
  for (ConcurrentRun* run : {&fast, &slow}) {
    run->predictor.revises = run->predictor.revises_early = true;
    run->predictor.wide_every = 9;
    run->config.window_submaps = 2;
    run->config.max_loops = 16;
    REQUIRE(run->go().outcome == Outcome::kFinished);
    CHECK(run->listener.windows >= 6);
    CHECK(run->listener.revisions >= 6);
    CHECK(run->info().loops > 0);
  }
  REQUIRE(fast.listener.live.size() == 40);
  REQUIRE(slow.listener.live.size() == 40);
  for (size_t k = 0; k < 40; ++k) {
    REQUIRE(same_bits(fast.listener.live[k].T_world_cam, slow.listener.live[k].T_world_cam));
    const auto id = static_cast<int32_t>(k);
    REQUIRE(same_bits(fast.pose(id).T_world_kf, slow.pose(id).T_world_kf));
  }
}

TEST_CASE("a predictor that could revise and does not has the bits of one that cannot") {
  ConcurrentRun could;
  ConcurrentRun cannot;
  cannot.predictor.table()->next_revision = nullptr;
  cannot.predictor.table()->next_wide_window = nullptr;
  for (ConcurrentRun* run : {&could, &cannot}) REQUIRE(run->go().outcome == Outcome::kFinished);
  REQUIRE(could.listener.live.size() == cannot.listener.live.size());
  for (size_t k = 0; k < could.listener.live.size(); ++k) {
    REQUIRE(same_bits(could.listener.live[k].T_world_cam, cannot.listener.live[k].T_world_cam));
  }
}

TEST_CASE("the answer for a window comes into the map a stated number of keyframes later") {
  ConcurrentRun run;
  run.windows_take(milliseconds(20));
  const Result& result = run.go();
  CHECK(result.lanes.beside);
  CHECK(result.lanes.lag == 3);  // half of the six keyframes between windows
  CHECK(result.lanes.asked >= 5);
  CHECK(result.lanes.late == 0);
  CHECK(result.lanes.dropped == 0);
  CHECK(result.lanes.waited_ms > 0.0);
  CHECK(run.listener.windows == run.info().submaps);
  CHECK(result.times.multi_view.count() >= result.lanes.asked);
}

TEST_CASE("a predictor without lanes is asked between two frames") {
  Run run;
  const Result& result = run.go();
  CHECK_FALSE(result.lanes.beside);
  CHECK(result.lanes.asked == 0);
}

TEST_CASE("a realtime run does not wait for windows: the newest are taken, the others counted") {
  ConcurrentRun run(90);
  run.options.realtime = true;
  run.options.keyframes.stride = 1;
  run.config.max_keyframes = 128;
  run.config.window_size = 4;
  run.config.window_overlap = 2;
  run.windows_take(milliseconds(400));
  const Result& result = run.go();
  REQUIRE(result.outcome == Outcome::kFinished);
  // A run that waited for its 44 windows would take 18 s for these 3 s and drop nearly all frames;
  // a loaded machine may drop some.
  CHECK(result.progress.frames_dropped < 45);
  CHECK(result.lanes.asked >= 1);
  CHECK(result.lanes.late > 0);
  CHECK(result.lanes.dropped > 5);
  CHECK(result.lanes.most_waiting > MapBuilder::kMostWaiting);
  CHECK(run.listener.told("windows behind"));
  CHECK(run.listener.told("more windows dropped"));
}

TEST_CASE(
    "what a window is refused for on the lane is told, and what ends the predictor ends the run") {
  ConcurrentRun run;
  SECTION("rejected") {
    run.predictor.rejected_windows = {6};
    CHECK(run.go().outcome == Outcome::kFinished);
    CHECK(run.listener.told("window of keyframes 6..13: scripted"));
  }
  SECTION("not finite") {
    run.predictor.nan_windows = {6};
    CHECK(run.go().outcome == Outcome::kFinished);
    CHECK(run.listener.told("not finite or has a wrong size"));
  }
  SECTION("failed") {
    run.predictor.failing_windows = {6};
    const Result& result = run.go();
    CHECK(result.outcome == Outcome::kPredictorFailed);
    CHECK(result.message == "scripted predictor: scripted");
  }
  SECTION("thrown") {
    run.predictor.before_window = [](int32_t first) {
      if (first == 6) throw std::runtime_error("out of patience");
    };
    const Result& result = run.go();
    CHECK(result.outcome == Outcome::kPredictorFailed);
    CHECK(result.message == "scripted predictor: out of patience");
  }
}

TEST_CASE("a run that is stopped takes the window in work") {
  ConcurrentRun run(100000);
  run.windows_take(milliseconds(50));
  run.source.before_frame = [&run](int64_t frame) {
    if (frame == 60) run.stop.store(true);
  };
  CHECK(run.go().outcome == Outcome::kStopped);
  CHECK(static_cast<size_t>(run.info().posed_keyframes) == run.predictor.keyframes.size());
  CHECK(run.listener.windows == run.info().submaps);
  CHECK(run.listener.windows > 0);
}

TEST_CASE("two lanes need a message of their own") {
  ConcurrentRun run;
  run.predictor.table()->window_message = nullptr;
  CHECK(run.go().outcome == Outcome::kSessionFailed);
}

TEST_CASE("tables of another size are refused when they are smaller, taken when they are larger") {
  Run run;
  SECTION("larger") {
    run.predictor.table()->struct_size += 64;
    run.source.table()->struct_size += 64;
    CHECK(run.go().outcome == Outcome::kFinished);
  }
  SECTION("predictor") {
    run.predictor.table()->struct_size = offsetof(unisim_predictor, place_descriptor) - 8;
    CHECK(run.go().message.find("predictor: struct_size") == 0);
  }
  SECTION("source") {
    run.source.table()->struct_size = 0;
    CHECK(run.go().message.find("source: struct_size") == 0);
  }
}
