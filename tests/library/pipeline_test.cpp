// SPDX-License-Identifier: MIT
// Runs behind the C header.
#include "drivers/library/pipeline.h"

#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "tests/library/c_run.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/text.hpp"

using namespace unisim::testing;

namespace {

double distance(const unisim_sim3& a, const unisim_sim3& b) {
  return std::hypot(a.t[0] - b.t[0], a.t[1] - b.t[1], a.t[2] - b.t[2]);
}

}  // namespace

TEST_CASE("a run gives poses, keyframes and states in order, and ends with its source") {
  CRun run;
  unisim_pipeline* const pipeline = run.start();
  INFO(run.message);
  REQUIRE(pipeline != nullptr);
  CHECK(wait_for_end(pipeline) == UNISIM_PIPELINE_FINISHED);
  CHECK(std::string(unisim_pipeline_message(pipeline)).empty());

  CHECK(run.told.keyframes.size() == 40);
  CHECK(run.told.poses.size() == 200 - 4);  // before the second keyframe nothing has a unit
  for (size_t k = 1; k < run.told.poses.size(); ++k) {
    REQUIRE(run.told.poses[k].timestamp_ns > run.told.poses[k - 1].timestamp_ns);
    REQUIRE(run.told.poses[k].segment == 0);
  }
  REQUIRE_FALSE(run.told.states.empty());
  CHECK(run.told.states.back() == UNISIM_STATE_TRACKING);

  unisim_pipeline_status status{};
  status.struct_size = sizeof status;
  unisim_pipeline_get_status(pipeline, &status);
  CHECK(status.frames == 200);
  CHECK(status.keyframes == 40);
  unisim_live_pose newest{};
  newest.struct_size = sizeof newest;
  REQUIRE(unisim_pipeline_get_pose(pipeline, &newest) == 1);
  CHECK(newest.timestamp_ns == run.told.poses.back().timestamp_ns);
  CHECK(unisim_pipeline_stop(pipeline) == UNISIM_PIPELINE_FINISHED);
}

TEST_CASE("poses and status say what is wrong with the frames") {
  CRun run;
  run.predictor.reasons = {{150, UNISIM_REASON_BLUR}, {199, UNISIM_REASON_TIME_GAP}};
  unisim_pipeline* const pipeline = run.start();
  REQUIRE(pipeline != nullptr);
  wait_for_end(pipeline);
  REQUIRE(run.told.poses.size() == 200 - 4);
  CHECK(run.told.poses[1].reason == UNISIM_REASON_START);  // so the frame before had it
  for (size_t k = 2; k < run.told.poses.size(); ++k) {
    const bool blurred = k + 4 == 151;  // frame k + 4; a reason is told with the next pose
    CHECK(run.told.poses[k].reason == (blurred ? UNISIM_REASON_BLUR : UNISIM_REASON_NONE));
  }
  unisim_pipeline_status status{};
  status.struct_size = sizeof status;
  unisim_pipeline_get_status(pipeline, &status);
  CHECK(status.reason == UNISIM_REASON_TIME_GAP);
  unisim_pipeline_stop(pipeline);
  CHECK(std::string(unisim_reason_name(UNISIM_REASON_TIME_GAP)) == "time gap");
  CHECK(std::string(unisim_reason_name(77)).empty());
}

TEST_CASE("a run that finds no start says why: as reason of its state and in full") {
  CRun run;
  run.predictor.pending_until = 1000;
  run.predictor.no_start = "no start: the camera only turned";
  run.predictor.reasons = {{199, UNISIM_REASON_TURNED}};
  unisim_pipeline* const pipeline = run.start();
  REQUIRE(pipeline != nullptr);
  CHECK(wait_for_end(pipeline) == UNISIM_PIPELINE_FINISHED);
  unisim_pipeline_status status{};
  status.struct_size = sizeof status;
  unisim_pipeline_get_status(pipeline, &status);
  CHECK(status.state == UNISIM_STATE_INIT);
  CHECK(status.reason == UNISIM_REASON_TURNED);
  CHECK(std::string(unisim_reason_name(status.reason)) == "no start yet: only turned");
  REQUIRE(run.told.lines.size() >= 2);  // while it goes on, and at its end
  CHECK(run.told.lines.front() == run.predictor.no_start);
  CHECK(run.told.lines.back() == run.predictor.no_start);
  unisim_pipeline_stop(pipeline);
}

TEST_CASE("corrections take the poses given out before to where they are now") {
  CRun run;
  run.predictor.window_noise = 0.02;
  run.predictor.revises = run.predictor.revises_early = true;
  unisim_pipeline* const pipeline = run.start();
  REQUIRE(pipeline != nullptr);
  CHECK(wait_for_end(pipeline) == UNISIM_PIPELINE_FINISHED);
  unisim_pipeline_stop(pipeline);
  REQUIRE(run.told.corrections.size() > 3);
  bool moved = false;
  for (size_t k = 0; k < run.told.corrections.size(); ++k) {
    const unisim_correction& one = run.told.corrections[k];
    CHECK(one.T_new_old.s > 0.0);
    CHECK(one.first_changed <= one.last_changed);
    if (k > 0) CHECK(one.map_revision > run.told.corrections[k - 1].map_revision);
    moved = moved || distance(one.T_new_old, {{0, 0, 0, 1}, {0, 0, 0}, 1}) > 1e-6;
  }
  CHECK(moved);
}

TEST_CASE("a callback and any other thread may ask a run to stop") {
  CRun run(1000000);
  std::atomic<unisim_pipeline*> pipeline{nullptr};
  SECTION("callback") { run.told.stops_after_pose = &pipeline; }
  SECTION("other thread") {}
  run.source.before_frame = [&](int64_t) {
    // The callback needs the pipeline's address, which start() is about to give.
    while (pipeline.load() == nullptr) std::this_thread::yield();
  };
  unisim_pipeline* const started = run.start();
  REQUIRE(started != nullptr);
  pipeline.store(started);
  if (run.told.stops_after_pose == nullptr) unisim_pipeline_ask_stop(started);
  CHECK(wait_for_end(started) == UNISIM_PIPELINE_STOPPED);
  CHECK(unisim_pipeline_stop(started) == UNISIM_PIPELINE_STOPPED);
}

TEST_CASE("a run that fails says why") {
  CRun run;
  run.source.fails_at = 100;
  unisim_pipeline* const pipeline = run.start();
  REQUIRE(pipeline != nullptr);
  CHECK(wait_for_end(pipeline) == UNISIM_PIPELINE_FAILED);
  CHECK_FALSE(std::string(unisim_pipeline_message(pipeline)).empty());
  CHECK(run.told.keyframes.size() == 20);
  CHECK(unisim_pipeline_stop(pipeline) == UNISIM_PIPELINE_FAILED);
}

TEST_CASE("what cannot be started is refused with one line") {
  CRun run;
  SECTION("no source") {
    run.config.source = nullptr;
    CHECK(run.start() == nullptr);
    CHECK(std::string(run.message).find("no source") != std::string::npos);
  }
  SECTION("a session that is refused") {
    run.session.window_overlap = run.session.window_size;
    CHECK(run.start() == nullptr);
    CHECK_FALSE(std::string(run.message).empty());
  }
  SECTION("an older struct") {
    run.config.struct_size = 8;
    CHECK(run.start() == nullptr);
    CHECK(std::string(run.message).find("struct_size") != std::string::npos);
  }
  SECTION("a newer struct that sets what is not known here") {
    struct {
      unisim_pipeline_config known;
      int64_t unknown;
    } newer = {run.config, 1};
    newer.known.struct_size = sizeof newer;
    CHECK(unisim_pipeline_start(&newer.known, run.message, sizeof run.message) == nullptr);
    CHECK(std::string(run.message).find("struct_size") != std::string::npos);
  }
  SECTION("a negative number of points") {
    run.config.lcm_points = -1;
    CHECK(run.start() == nullptr);
    CHECK(std::string(run.message).find("lcm_points") != std::string::npos);
  }
  SECTION("no room for the line") {
    run.config.source = nullptr;
    CHECK(unisim_pipeline_start(&run.config, nullptr, 0) == nullptr);
  }
  CHECK(unisim_pipeline_stop(nullptr) == UNISIM_PIPELINE_FINISHED);
}

TEST_CASE("configurations of an older and of a newer release start a run") {
  CRun run;
  struct {
    unisim_pipeline_config known;
    char unknown[16];
  } given;
  std::memset(&given, 0, sizeof given);
  SECTION("older: what follows is not read") {
    const size_t old_size = offsetof(unisim_pipeline_config, lcm);
    std::memset(&given, 0x55, sizeof given);
    std::memcpy(static_cast<void*>(&given), &run.config, old_size);
    given.known.struct_size = static_cast<uint32_t>(old_size);
  }
  SECTION("newer: what follows is as before") {
    given.known = run.config;
    given.known.struct_size = sizeof given;
  }
  unisim_pipeline* const pipeline =
      unisim_pipeline_start(&given.known, run.message, sizeof run.message);
  INFO(run.message);
  REQUIRE(pipeline != nullptr);
  CHECK(wait_for_end(pipeline) == UNISIM_PIPELINE_FINISHED);
  CHECK(run.told.keyframes.size() == 40);
  unisim_pipeline_stop(pipeline);
}

TEST_CASE("structs of another size are filled as far as both sides know them") {
  CRun run;
  unisim_pipeline* const pipeline = run.start();
  REQUIRE(pipeline != nullptr);
  wait_for_end(pipeline);
  struct Larger {
    unisim_pipeline_status known;
    char tail[16];
  } larger;
  std::memset(&larger, 0x55, sizeof larger);
  larger.known.struct_size = sizeof larger;
  unisim_pipeline_get_status(pipeline, &larger.known);
  CHECK(larger.known.struct_size == sizeof larger);
  CHECK(larger.known.frames == 200);
  for (const char byte : larger.tail) CHECK(byte == 0);
  unisim_pipeline_status smaller;
  std::memset(&smaller, 0x55, sizeof smaller);
  smaller.struct_size = 16;
  unisim_pipeline_get_status(pipeline, &smaller);
  CHECK(smaller.frames == 200);
  CHECK(smaller.keyframes == 0x55555555);
  unisim_pipeline_stop(pipeline);
}

TEST_CASE("a run saves its map, and another one goes on in it or only looks into it") {
  const TempFolder folder;
  const std::string path = folder / "room.map";
  CRun first(100);
  first.session.live_scale_exponent = 1.0;  // as found, so that first poses compare
  first.config.save_map = path.c_str();
  unisim_pipeline* pipeline = first.start();
  INFO(first.message);
  REQUIRE(pipeline != nullptr);
  CHECK(wait_for_end(pipeline) == UNISIM_PIPELINE_FINISHED);
  CHECK(std::string(unisim_pipeline_message(pipeline)).empty());
  CHECK(unisim_pipeline_stop(pipeline) == UNISIM_PIPELINE_FINISHED);
  const std::string saved = read_file(path);
  REQUIRE_FALSE(saved.empty());

  CRun second(60);
  second.session.live_scale_exponent = 1.0;
  second.config.load_map = path.c_str();
  SECTION("goes on") {
    pipeline = second.start();
    INFO(second.message);
    REQUIRE(pipeline != nullptr);
    CHECK(wait_for_end(pipeline) == UNISIM_PIPELINE_FINISHED);
    CHECK(unisim_pipeline_stop(pipeline) == UNISIM_PIPELINE_FINISHED);
    REQUIRE(second.told.keyframes.size() == 12);
    CHECK(second.told.keyframes.front().keyframe_id == 20);
    // The same way again, in the frame and the unit of the first run.
    for (size_t k = 0; k < 12; ++k) {
      CHECK(second.told.keyframes[k].segment == 0);
      CHECK(distance(second.told.keyframes[k].T_world_kf, first.told.keyframes[k].T_world_kf) <
            0.01);
    }
  }
  SECTION("only looks into it") {
    second.config.localise = 1;
    second.config.stride = 0;
    pipeline = second.start();
    INFO(second.message);
    REQUIRE(pipeline != nullptr);
    CHECK(wait_for_end(pipeline) == UNISIM_PIPELINE_FINISHED);
    CHECK(unisim_pipeline_stop(pipeline) == UNISIM_PIPELINE_FINISHED);
    CHECK(second.told.poses.size() == 60 - 9);
    CHECK(second.told.keyframes.empty());
    CHECK(second.told.lines.size() == 6);  // five of those not found, and how many more
    CHECK(read_file(path) == saved);
  }
  SECTION("a session of another shape is refused before it runs") {
    second.session.window_size = 6;
    CHECK(second.start() == nullptr);
    CHECK(has(second.message, "session.window_size = 8"));
  }
  SECTION("no map, no localising") {
    second.config.localise = 1;
    second.config.load_map = nullptr;
    CHECK(second.start() == nullptr);
    CHECK(has(second.message, "load_map"));
  }
}
