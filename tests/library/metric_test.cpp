// SPDX-License-Identifier: MIT
// Runs behind the C header that are told lengths: they know how long a metre is.
#include <atomic>
#include <cmath>
#include <limits>
#include <thread>

#include "tests/library/c_run.hpp"
#include "tests/support/text.hpp"

using namespace unisim::testing;

namespace {

constexpr double kMetre = 0.7;  // metres in a length of the scripted world

double way(int64_t from, int64_t to) {
  const unisim_sim3 a = true_pose(from);
  const unisim_sim3 b = true_pose(to);
  return kMetre * std::hypot(a.t[0] - b.t[0], a.t[1] - b.t[1], a.t[2] - b.t[2]);
}

int64_t stamp(int64_t frame) { return frame * 33333333; }

unisim_odometry_step step_to(int64_t frame) {
  unisim_odometry_step step{};
  step.struct_size = sizeof step;
  step.from_ns = stamp(frame - 1);
  step.to_ns = stamp(frame);
  step.metres = way(frame - 1, frame);
  return step;
}

unisim_distance between(int32_t i, int32_t j) {
  unisim_distance distance{};
  distance.struct_size = sizeof distance;
  distance.i = i;
  distance.j = j;
  distance.metres = way(5 * i, 5 * j);
  distance.sigma = 0.01 * distance.metres;
  return distance;
}

unisim_pipeline_status status_of(const unisim_pipeline* pipeline) {
  unisim_pipeline_status status{};
  status.struct_size = sizeof status;
  unisim_pipeline_get_status(pipeline, &status);
  return status;
}

double expected() { return kMetre / ScriptedPredictor::pair_unit(0); }

}  // namespace

TEST_CASE("odometry that comes while a run goes makes it metric from some pose on") {
  const int late = GENERATE(0, 7);  // frames by which the odometry is behind the camera
  CRun run;
  std::atomic<unisim_pipeline*> started{nullptr};
  int refused = 0;
  run.source.before_frame = [&](int64_t frame) {
    while (started.load() == nullptr) std::this_thread::yield();
    if (frame <= late) return;
    const unisim_odometry_step step = step_to(frame - late);
    if (unisim_pipeline_add_odometry(started.load(), &step) == 0) ++refused;
  };
  unisim_pipeline* const pipeline = run.start();
  INFO(run.message);
  REQUIRE(pipeline != nullptr);
  started.store(pipeline);
  REQUIRE(wait_for_end(pipeline) == UNISIM_PIPELINE_FINISHED);
  CHECK(refused == 0);
  const unisim_pipeline_status status = status_of(pipeline);
  CHECK(status.metres_per_unit == Approx(expected()).epsilon(0.03));
  CHECK(status.scale_sigma >= 0.05);  // what a wheel has wrong all the time
  CHECK(status.scale_sigma < 0.06);
  CHECK(run.told.poses.front().metres_per_unit == 0.0);
  CHECK(run.told.poses.back().metres_per_unit == Approx(expected()).epsilon(0.03));
  REQUIRE_FALSE(run.told.corrections.empty());
  CHECK(run.told.corrections.back().scale_sigma > 0.0);
  unisim_pipeline_stop(pipeline);
}

TEST_CASE("a known distance of two keyframes makes a run metric") {
  CRun run;
  struct Host {
    Told* told;
    std::atomic<unisim_pipeline*> pipeline{nullptr};
  } host;
  host.told = &run.told;
  run.config.user = &host;
  run.config.on_pose = nullptr;
  run.config.on_correction = nullptr;
  run.config.on_state = nullptr;
  run.config.on_message = [](const char* line, void* user) {
    static_cast<Host*>(user)->told->lines.emplace_back(line);
  };
  run.config.on_keyframe = [](const unisim_pose* pose, void* user) {
    auto* me = static_cast<Host*>(user);
    while (me->pipeline.load() == nullptr) std::this_thread::yield();
    if (pose->keyframe_id != 12) return;
    const unisim_distance good = between(8, 12);
    CHECK(unisim_pipeline_add_distance(me->pipeline.load(), &good) == 1);
    const unisim_distance unknown = between(8, 1000);
    CHECK(unisim_pipeline_add_distance(me->pipeline.load(), &unknown) == 1);
  };
  unisim_pipeline* const pipeline = run.start();
  REQUIRE(pipeline != nullptr);
  host.pipeline.store(pipeline);
  REQUIRE(wait_for_end(pipeline) == UNISIM_PIPELINE_FINISHED);
  CHECK(status_of(pipeline).metres_per_unit == Approx(expected()).epsilon(0.01));
  CHECK(status_of(pipeline).scale_sigma < 0.03);
  REQUIRE(run.told.lines.size() == 1);
  CHECK(has(run.told.lines[0], "distance of keyframes 8 and 1000"));
  unisim_pipeline_stop(pipeline);
}

TEST_CASE("lengths that make no sense are refused, and a run without any is relative") {
  CRun run;
  std::atomic<bool> go{false};
  run.source.before_frame = [&](int64_t) {
    while (!go.load()) std::this_thread::yield();
  };
  unisim_pipeline* const pipeline = run.start();
  REQUIRE(pipeline != nullptr);
  const auto refused = [&](auto change) {
    unisim_odometry_step step = step_to(5);
    change(&step);
    return unisim_pipeline_add_odometry(pipeline, &step) == 0;
  };
  CHECK(refused([](auto* step) { step->struct_size = 8; }));
  CHECK(refused([](auto* step) { step->to_ns = step->from_ns; }));
  CHECK(refused([](auto* step) { step->metres = -0.1; }));
  CHECK(refused([](auto* step) { step->metres = std::numeric_limits<double>::infinity(); }));
  CHECK(refused([](auto* step) { step->sigma = 2.0; }));
  CHECK(refused([](auto* step) { step->common_sigma = -1.0; }));
  CHECK(unisim_pipeline_add_odometry(pipeline, nullptr) == 0);
  CHECK(unisim_pipeline_add_odometry(nullptr, nullptr) == 0);
  CHECK(unisim_pipeline_add_distance(pipeline, nullptr) == 0);
  const unisim_odometry_step later = step_to(1000);
  CHECK(unisim_pipeline_add_odometry(pipeline, &later) == 1);
  CHECK(refused([](auto*) {}));  // before the one that was taken
  go.store(true);
  CHECK(wait_for_end(pipeline) == UNISIM_PIPELINE_FINISHED);
  CHECK(status_of(pipeline).metres_per_unit == 0.0);
  CHECK(run.told.poses.back().metres_per_unit == 0.0);
  unisim_pipeline_stop(pipeline);
}

TEST_CASE("a camera height that is none is refused") {
  CRun run;
  run.config.camera_height = -1.0;
  CHECK(run.start() == nullptr);
  CHECK(has(run.message, "camera_height"));
}
