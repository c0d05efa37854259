// SPDX-License-Identifier: MIT
// Loops of predictors without a map of their own, on simulated walks of two rounds.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

#include "drivers/common/owned.hpp"
#include "drivers/recorded/recorded.h"
#include "tests/pipeline/scripted_run.hpp"
#include "tests/pipeline/walk_predictor.hpp"
#include "tests/support/temp_folder.hpp"
#include "tools/bench/simulator/loops.hpp"
#include "tools/eval/alignment.hpp"

using namespace unisim;
using namespace unisim::testing;

namespace {

constexpr int32_t kRound = 336;  // keyframes
constexpr int32_t kTwoRounds = 2 * kRound;

const simulator::World& two_rounds() {
  static const simulator::World world =
      simulator::make_world(simulator::WorldKind::kWalk, kTwoRounds, 1);
  return world;
}

struct Walk {
  explicit Walk(const simulator::World& walked = two_rounds(), uint64_t seed = 1)
      : world(walked),
        source(walked.keyframes()),
        predictor(walked, seed),
        asked(predictor.table()) {
    REQUIRE(unisim_config_init(&config, sizeof config) == UNISIM_OK);
    config.max_keyframes = 1024;
    config.window_submaps = 2;
    options.keyframes.stride = 1;
  }

  const Result& go() {
    pipeline = std::make_unique<Pipeline>(options, source.table(), asked, config,
                                          std::vector<Listener*>{&listener});
    const Result& result = pipeline->run();
    REQUIRE(result.outcome == Outcome::kFinished);
    const unisim_predictor_info& info = result.predictor;
    reports.assign(info.places, info.places + info.place_count);
    return result;
  }

  unisim_sim3 pose(int32_t k) const {
    unisim_sim3 T{};
    if (listener.book.find(pipeline->session(), k, &T)) return T;
    unisim_pose out{};
    out.struct_size = sizeof out;
    REQUIRE(unisim_get_pose(pipeline->session(), k, &out) == UNISIM_OK);
    return out.T_world_kf;
  }

  double ate() const {
    std::vector<Eigen::Vector3d> found, truth;
    for (int32_t k = 0; k < world.keyframes(); ++k) {
      found.emplace_back(pose(k).t);
      truth.push_back(world.T_world_kf[static_cast<size_t>(k)].t);
    }
    const eval::Similarity T = eval::align(found, truth, eval::Alignment::kSim3);
    double sum = 0.0;
    for (size_t k = 0; k < truth.size(); ++k) sum += (T * found[k] - truth[k]).squaredNorm();
    return std::sqrt(sum / static_cast<double>(truth.size()));
  }

  unisim_session_info info() const {
    unisim_session_info out{};
    out.struct_size = sizeof out;
    REQUIRE(unisim_get_info(pipeline->session(), &out) == UNISIM_OK);
    return out;
  }

  const simulator::World& world;
  ScriptedSource source;
  WalkPredictor predictor;
  unisim_predictor* asked;  ///< predictor, or what stands before it
  unisim_config config;
  Options options;
  Recorder listener;
  std::unique_ptr<Pipeline> pipeline;
  std::vector<unisim_place_report> reports;
};

bool closed(const std::vector<unisim_place_report>& reports, const simulator::Loop& loop) {
  return std::any_of(reports.begin(), reports.end(), [&](const unisim_place_report& report) {
    return report.accepted != 0 && std::abs(report.keyframe - loop.query) <= 14 &&
           std::abs(report.candidate - loop.match) <= 16;
  });
}

}  // namespace

TEST_CASE("loops take the drift out of a walk of two rounds") {
  const uint64_t seed = GENERATE(1U, 2U, 3U);
  const simulator::World world =
      simulator::make_world(simulator::WorldKind::kWalk, kTwoRounds, seed);
  Walk with(world, seed);
  Walk without(world, seed);
  without.options.loops.places = 0;
  const Result& result = with.go();
  without.go();
  CHECK(without.predictor.kept() == 0);
  CHECK(without.reports.empty());
  CHECK(result.predictor.loops_accepted >= 10);
  CHECK(result.predictor.loops_tried >= result.predictor.loops_accepted);
  INFO(with.ate() << " m with loops, " << without.ate() << " without");
  CHECK(with.ate() <= 0.35 * without.ate());
  for (const simulator::Loop& loop : simulator::find_loops(with.world)) {
    INFO("query " << loop.query << " match " << loop.match);
    CHECK(closed(with.reports, loop));
  }
  CHECK(with.predictor.calls_astray() == 0);
}

TEST_CASE("a replay with loops on a lane of their own gives the same bits twice") {
  Walk first;
  Walk second;
  first.predictor.table()->concurrent_windows = 1;
  second.predictor.table()->concurrent_windows = 1;
  const int32_t loops = first.go().predictor.loops_accepted;
  CHECK(loops >= 10);
  CHECK(second.go().predictor.loops_accepted == loops);
  CHECK(first.predictor.calls_astray() == 0);
  for (int32_t k = 0; k < first.world.keyframes(); ++k) {
    const unisim_sim3 a = first.pose(k);
    const unisim_sim3 b = second.pose(k);
    REQUIRE(std::memcmp(&a, &b, sizeof a) == 0);
  }
}

TEST_CASE("a recording repeats the loops of the run, bit for bit") {
  const TempFolder folder;
  const std::string file = folder / "walk.usr";
  Walk first;
  Walk second;
  first.predictor.table()->concurrent_windows = 1;
  {
    const drivers::PredictorPtr recorder(
        unisim_recorder_create(first.predictor.table(), file.c_str(), "walk", nullptr, 0));
    REQUIRE(recorder != nullptr);
    first.asked = recorder.get();
    first.go();
  }
  char message[256] = "";
  const drivers::PredictorPtr recorded(unisim_recorded_open(file.c_str(), message, sizeof message));
  INFO(message);
  REQUIRE(recorded != nullptr);
  int32_t size = 0;
  int32_t overlap = 0;
  REQUIRE(unisim_recorded_windows(recorded.get(), &size, &overlap) == 1);
  CHECK(size == first.config.window_size);
  CHECK(overlap == first.config.window_overlap);
  second.asked = recorded.get();
  CHECK(second.go().predictor.loops_accepted >= 10);
  CHECK(second.reports.size() == first.reports.size());
  for (int32_t k = 0; k < first.world.keyframes(); ++k) {
    const unisim_sim3 a = first.pose(k);
    const unisim_sim3 b = second.pose(k);
    REQUIRE(std::memcmp(&a, &b, sizeof a) == 0);
  }
}

TEST_CASE("places that only look alike make no loop") {
  // It ends before it is back where it began.
  const simulator::World round = simulator::make_world(simulator::WorldKind::kWalk, kRound - 36, 2);
  Walk walk(round);
  walk.predictor.look = {150, 300, 120};
  const Result& result = walk.go();
  CHECK(result.predictor.loops_accepted == 0);
  CHECK(walk.info().loops == 0);
  CHECK(result.predictor.loops_tried > 20);
  for (const unisim_place_report& report : walk.reports) {
    CHECK(report.accepted == 0);
    CHECK(report.reason != nullptr);
  }
}

TEST_CASE("a false loop that passes every look is undone by the map") {
  Walk fooled;
  Walk honest;
  fooled.predictor.lie = {500, 512, 120};
  const Result& result = fooled.go();
  honest.go();
  const bool false_loop = std::any_of(
      fooled.reports.begin(), fooled.reports.end(), [](const unisim_place_report& report) {
        return report.accepted != 0 && std::abs(report.keyframe - 120 - report.candidate) < 20;
      });
  REQUIRE(false_loop);
  CHECK(result.predictor.loops_accepted > 5);
  CHECK(fooled.info().loop_suspensions >= 1);
  CHECK(result.predictor.loops_undone == fooled.info().suspended_loops);
  CHECK(result.predictor.loops_undone >= 1);
  CHECK(fooled.ate() < 1.5 * honest.ate());
}

TEST_CASE("the places kept stay within their number, and the predictor is told what may go") {
  Walk walk;
  walk.options.loops.places = 64;
  const Result& result = walk.go();
  CHECK(walk.predictor.most_kept() <= 64 + 2 * UNISIM_WINDOW_LAG);
  CHECK(walk.predictor.kept() <= 64);
  CHECK(walk.predictor.calls_astray() == 0);
  CHECK(result.predictor.loops_accepted > 0);
}

TEST_CASE("places leave with the keyframes that the map forgets") {
  Walk walk;
  walk.config.max_keyframes = (2 + 9) * walk.config.window_size;
  walk.go();
  CHECK(walk.predictor.kept() <= walk.config.max_keyframes);
  CHECK(walk.predictor.calls_astray() == 0);
}

TEST_CASE("a descriptor of a wrong length or of nothing costs its keyframe only") {
  Walk walk;
  walk.predictor.wrong_size = {{100, 3}, {101, 0}};
  walk.predictor.blank = {200, 201};
  const Result& result = walk.go();
  CHECK(walk.listener.told("keyframe 100: has 3 numbers where others have 256"));
  CHECK(walk.listener.told("keyframe 101: has 0 numbers"));
  CHECK(result.predictor.loops_accepted >= 10);
  CHECK(walk.predictor.calls_astray() == 0);
}

TEST_CASE("a predictor whose table ends before the places has no loops") {
  Walk walk;
  walk.predictor.table()->struct_size = offsetof(unisim_predictor, place_descriptor);
  const Result& result = walk.go();
  CHECK(result.predictor.loops_tried == 0);
  CHECK(walk.predictor.distant_asked() == 0);
}
