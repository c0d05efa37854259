// SPDX-License-Identifier: MIT
// The pipeline with a scripted predictor and the real session.
#include "drivers/pipeline/pipeline.hpp"

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "drivers/pipeline/similarity.hpp"
#include "tests/pipeline/scripted_run.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::testing;

TEST_CASE("exact predictions give the exact trajectory") {
  Run run;
  const Result& result = run.go();
  REQUIRE(result.outcome == Outcome::kFinished);
  REQUIRE(run.predictor.keyframes.size() == 40);
  CHECK(run.predictor.observed == 200);
  CHECK(run.predictor.keyframes[7] == 35);
  CHECK(run.info().posed_keyframes == 40);
  CHECK(run.listener.windows == run.info().submaps);
  CHECK(run.worst_error() < 1e-6);
  REQUIRE(run.listener.live.size() == 40);
  for (size_t k = 0; k < 40; ++k) {
    CHECK(Run::distance(run.listener.live[k].T_world_cam, run.predictor.keyframes[k]) < 1e-6);
  }
}

TEST_CASE("the last keyframes are covered by a shorter window") {
  Run run;
  run.go();
  CHECK(run.pose(39).submap_id >= 0);
}

TEST_CASE("poses come late, but all of them, while the predictor starts") {
  Run run;
  run.predictor.pending_until = 13;
  const Result& result = run.go();
  REQUIRE(result.outcome == Outcome::kFinished);
  CHECK(run.listener.live.size() == 40);
  CHECK(run.info().posed_keyframes == 40);
  CHECK(run.worst_error() < 1e-6);
}

TEST_CASE("a predictor that never starts leaves no poses and no error") {
  Run run;
  run.predictor.pending_until = 1000;
  const Result& result = run.go();
  CHECK(result.outcome == Outcome::kFinished);
  CHECK(run.listener.live.empty());
  CHECK(run.info().submaps == 0);
}

TEST_CASE("a rejected pair is told, counted and survived") {
  Run run;
  run.predictor.rejected_pairs = {11};
  const Result& result = run.go();
  CHECK(result.outcome == Outcome::kFinished);
  CHECK(run.info().pairs_refused == 1);
  CHECK(run.listener.told("pair 11,12: scripted"));
}

TEST_CASE("a window that the map leaves out is told with the reason") {
  Run run;
  run.predictor.uncertain_windows = {6};
  const Result& result = run.go();
  CHECK(result.outcome == Outcome::kFinished);
  CHECK(run.listener.told("window of keyframes 6..13: left out, its poses are uncertain by 0.5"));
}

TEST_CASE("a rejected window is told and survived") {
  Run run;
  run.predictor.rejected_windows = {6};
  const Result& result = run.go();
  CHECK(result.outcome == Outcome::kFinished);
  CHECK(run.listener.told("window of keyframes 6..13: scripted"));
  CHECK(run.worst_error() < 1e-6);
}

TEST_CASE("predictions that are not finite or of the wrong size are refused, not fatal") {
  Run run;
  SECTION("pair pose") { run.predictor.nan_pairs = {4}; }
  SECTION("pair depth") { run.predictor.empty_pairs = {4}; }
  SECTION("window pose") { run.predictor.nan_windows = {6}; }
  SECTION("window ids") { run.predictor.wrong_window_ids = true; }
  CHECK(run.go().outcome == Outcome::kFinished);
  CHECK(run.listener.told("not finite or has a wrong size"));
}

TEST_CASE("messages of one kind are told five times, then counted") {
  Run run;
  for (int64_t k = 50; k < 70; ++k) run.source.bad.insert(k);
  run.go();
  int told = 0;
  for (const std::string& line : run.listener.lines) {
    if (line.find(": scripted") != std::string::npos) ++told;
  }
  CHECK(told == 5);
  CHECK(run.listener.told("and 15 more unreadable frames"));
}

TEST_CASE("the stop flag ends the run with what there is") {
  Run run(100000);
  run.source.before_frame = [&run](int64_t frame) {
    if (frame == 60) run.stop.store(true);
  };
  const Result& result = run.go();
  CHECK(result.outcome == Outcome::kStopped);
  REQUIRE(run.predictor.keyframes.size() >= 8);
  CHECK(run.predictor.keyframes.size() <= 13);
  CHECK(static_cast<size_t>(run.info().posed_keyframes) == run.predictor.keyframes.size());
  CHECK(run.worst_error() < 1e-6);
}

TEST_CASE("a full map ends the run with a complete map") {
  Run run;
  run.config.max_keyframes = 20;
  const Result& result = run.go();
  CHECK(result.outcome == Outcome::kCapacity);
  CHECK(result.message.find("raise session.max_keyframes") != std::string::npos);
  CHECK(run.info().posed_keyframes == 20);
  CHECK(run.worst_error() < 1e-6);
}

TEST_CASE("unreadable, resized and repeated frames are skipped and counted") {
  Run run;
  run.source.bad = {17};
  run.source.resized = {31, 32};
  run.source.repeated_time = {44};
  const Result& result = run.go();
  CHECK(result.outcome == Outcome::kFinished);
  CHECK(result.progress.frames_bad == 4);
  CHECK(result.progress.frames == 196);
  CHECK(run.listener.told("frame 31: image is 16x11 gray, the first one was 16x12 gray"));
  CHECK(run.listener.told("frame 44: time stamp is not after the one before"));
}

TEST_CASE("a source or predictor that gives up ends the run with what there is") {
  Run run;
  SECTION("source") {
    run.source.fails_at = 100;
    CHECK(run.go().outcome == Outcome::kSourceFailed);
    CHECK(run.info().posed_keyframes == 20);
  }
  SECTION("predictor") {
    run.predictor.fails_at = 100;
    CHECK(run.go().outcome == Outcome::kPredictorFailed);
    CHECK(run.info().posed_keyframes == 20);
  }
}

TEST_CASE("a configuration the session refuses is known before any frame is read") {
  Run run;
  run.config.window_overlap = run.config.window_size;
  Pipeline pipeline(run.options, run.source.table(), run.predictor.table(), run.config, {});
  CHECK(pipeline.prepare().answer == Preparation::Answer::kBadConfiguration);
  CHECK(pipeline.run().outcome == Outcome::kSessionFailed);
  CHECK(run.predictor.observed == 0);
}

TEST_CASE("pixels reach the predictor whole, whoever of the two threads is slower") {
  Run run(120);
  SECTION("slow source") {
    run.source.before_frame = [](int64_t) {
      std::this_thread::sleep_for(std::chrono::microseconds(300));
    };
  }
  SECTION("fast source, short queue") { run.options.queue_frames = 1; }
  run.go();
  CHECK(run.predictor.observed == 120);
  CHECK(run.predictor.moved_off == 0);
}

TEST_CASE("two runs give the same bits, however the threads are timed") {
  Run first;
  Run second;
  second.options.queue_frames = 1;
  second.source.before_frame = [](int64_t frame) {
    std::this_thread::sleep_for(std::chrono::microseconds(frame % 7 * 100));
  };
  for (Run* run : {&first, &second}) {
    run->predictor.window_noise = 0.01;
    run->options.keyframes.stride = 0;
    run->predictor.flow = 0.007;
    run->go();
  }
  REQUIRE(first.predictor.keyframes == second.predictor.keyframes);
  REQUIRE(first.predictor.keyframes.size() == 40);
  for (int32_t k = 0; k < 40; ++k) {
    const unisim_sim3 a = first.pose(k).T_world_kf;
    const unisim_sim3 b = second.pose(k).T_world_kf;
    for (int part = 0; part < 4; ++part) REQUIRE(a.q[part] == b.q[part]);
    for (int part = 0; part < 3; ++part) REQUIRE(a.t[part] == b.t[part]);
    REQUIRE(a.s == b.s);
  }
}

TEST_CASE("frames between keyframes are posed when asked for") {
  Run run;
  run.options.every_frame = true;
  run.go();
  // Before the second keyframe there is no pair and no unit to pose them in.
  CHECK(run.listener.between.size() == 200 - 40 - 4);
  CHECK(run.listener.live.size() == 200 - 4);
  for (const BetweenPose& between : run.listener.between) {
    const unisim_sim3 T = compose(run.pose(between.keyframe_id).T_world_kf, between.T_kf_frame);
    const int64_t frame = between.timestamp_ns / 33333333;
    REQUIRE(Run::distance(T, frame) < 1e-6);
  }
}

TEST_CASE("windows measured anew replace the old measurement") {
  Run run;
  run.predictor.window_noise = 0.02;
  run.go();
  const double before = run.worst_error();
  Run revised;
  revised.predictor.window_noise = 0.02;
  revised.predictor.revises = true;
  revised.go();
  CHECK(before > 1e-3);
  CHECK(revised.listener.revisions >= 5);
  // The last window is asked for after the revisions and keeps its noise.
  CHECK(revised.worst_error() < before);
  double first_half = 0.0;
  for (int32_t k = 0; k < 20; ++k) {
    const unisim_sim3 T = revised.pose(k).T_world_kf;
    first_half = std::max(first_half, Run::distance(T, 5 * k));
  }
  CHECK(first_half < 1e-3);
}

TEST_CASE("wide windows correct what has left the sliding window, newer ones in place of older") {
  constexpr int32_t kKeyframes = 120;
  const auto mean_error = [](int32_t wide_every) {
    Run run(5 * kKeyframes);
    run.config.max_keyframes = 256;
    run.predictor.window_bend = 0.00005;
    run.predictor.wide_every = wide_every;
    run.config.window_submaps = 2;
    run.config.max_loops = 16;
    const Result& result = run.go();
    REQUIRE(result.outcome == Outcome::kFinished);
    CHECK(run.info().retired_keyframes > 0);
    // None is asked for before something has left the window, the last one stays.
    CHECK(run.info().loops < 13);
    CHECK((run.info().loops > 5) == (wide_every > 0));
    CHECK(run.info().loops - run.info().loops_removed == (wide_every > 0 ? 1 : 0));
    double sum = 0.0;
    for (int32_t k = 0; k < kKeyframes; ++k) sum += Run::distance(run.pose(k).T_world_kf, 5 * k);
    return sum / kKeyframes;
  };
  const double without = mean_error(0);
  const double with = mean_error(9);
  CHECK(with < 0.95 * without);
}

TEST_CASE("a wide window over two segments joins them, a newer one takes its place") {
  const auto wide_every = GENERATE(0, 12);
  Run run(300);
  run.config.max_loops = 16;
  run.config.window_size = 16;
  run.predictor.wide_every = wide_every;
  for (const int32_t pair : {17, 18, 19, 20}) run.predictor.rejected_pairs.insert(pair);
  for (int32_t first = 3; first <= 20; ++first) run.predictor.rejected_windows.insert(first);
  REQUIRE(run.go().outcome == Outcome::kFinished);
  CHECK(run.info().retired_keyframes == 0);
  CHECK(run.info().segments == (wide_every > 0 ? 1 : 2));
  CHECK(run.info().loops - run.info().loops_removed == (wide_every > 0 ? 1 : 0));
  if (wide_every == 0) return;
  CHECK(run.info().loops > 1);
  CHECK(run.pose(0).segment == run.pose(35).segment);
  CHECK(Run::distance(run.pose(35).T_world_kf, 5 * 35) < 1e-3);
}

TEST_CASE("wide windows are taken after a gap, which windows of neighbours may not reach over") {
  const auto lost = GENERATE(false, true);
  Run run(300);
  run.config.max_loops = 16;
  run.predictor.wide_every = 12;
  if (lost) {
    for (const int32_t pair : {17, 18, 19}) run.predictor.rejected_pairs.insert(pair);
    run.predictor.found_again = 20;
    run.predictor.gap = 3;
    for (int32_t first = 11; first <= 20; ++first) run.predictor.rejected_windows.insert(first);
  }
  REQUIRE(run.go().outcome == Outcome::kFinished);
  CHECK(run.info().retired_keyframes == 0);
  CHECK(run.info().segments == 1);
  CHECK((run.info().loops > 0) == lost);
  CHECK(Run::distance(run.pose(35).T_world_kf, 5 * 35) < 1e-3);
}

TEST_CASE("no wide window is asked for while the sliding window holds every keyframe") {
  Run run;
  run.predictor.wide_every = 9;
  run.config.max_loops = 16;
  REQUIRE(run.go().outcome == Outcome::kFinished);
  CHECK(run.info().retired_keyframes == 0);
  CHECK(run.predictor.wide_given == 0);
}

TEST_CASE("a realtime run drops the frames it is late for") {
  Run run(30);
  run.options.realtime = true;
  run.source.before_frame = [](int64_t frame) {
    if (frame == 10) std::this_thread::sleep_for(std::chrono::milliseconds(600));
  };
  const Result& result = run.go();
  CHECK(result.progress.frames_dropped > 0);
  CHECK(result.progress.frames + result.progress.frames_dropped == 30);
  CHECK(result.wall_s > 0.9);
}

TEST_CASE("every call of the session is timed and watched for heap calls") {
  static int64_t entered;
  static bool inside;
  static bool nested;
  entered = 0;
  inside = nested = false;
  HeapWatch watch;
  watch.enter = [] {
    nested = nested || inside;
    inside = true;
    ++entered;
  };
  watch.leave = [] { inside = false; };
  watch.count = [] { return int64_t{0}; };
  Run run;
  run.options.every_frame = true;
  run.predictor.revises = true;
  run.predictor.rejected_pairs = {11};
  Pipeline pipeline(run.options, run.source.table(), run.predictor.table(), run.config, {}, nullptr,
                    watch);
  const StageTimes& times = pipeline.run().times;
  int64_t timed = 0;
  for (const LatencyHistogram* stage :
       {&times.graph, &times.depth_ratio, &times.optimize, &times.read}) {
    timed += stage->count();
  }
  // 160 frames between keyframes are placed by a pose that is read from the session.
  CHECK(times.read.count() > 160);
  CHECK(entered == timed);
  CHECK_FALSE(inside);
  CHECK_FALSE(nested);
}
