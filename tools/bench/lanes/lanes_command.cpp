// SPDX-License-Identifier: MIT
// unisim-bench lanes: what a predictor that takes long for its windows costs the live pose.
#include "tools/bench/lanes/lanes_command.hpp"

#include <string>
#include <vector>

#include "drivers/common/median.hpp"
#include "drivers/pipeline/pipeline.hpp"
#include "tools/bench/lanes/timed_predictor.hpp"
#include "tools/bench/times.hpp"
#include "tools/common/failure.hpp"

namespace unisim::bench {
namespace {

constexpr uint64_t kSeed = 1;
constexpr int32_t kStride = 5;
constexpr int64_t kFrameNs = 33333333;  // 30 a second

/// Frames without pixels.
struct BlankSource {
  unisim_source table{};  // first: the table's address is the source's
  int64_t frames = 0;
  int64_t next = 0;

  explicit BlankSource(int64_t count) : frames(count) {
    table.struct_size = sizeof table;
    table.format = "simulated";
    table.frame_count = [](unisim_source* s) { return reinterpret_cast<BlankSource*>(s)->frames; };
    table.next_frame = [](unisim_source* s, int, unisim_frame* frame) {
      auto* me = reinterpret_cast<BlankSource*>(s);
      if (me->next == me->frames) return UNISIM_FRAME_END;
      *frame = {};
      frame->index = me->next;
      frame->timestamp_ns = ++me->next * kFrameNs;
      return UNISIM_FRAME_OK;
    };
    table.ground_truth = [](unisim_source*, const unisim_stamped_pose**) { return int64_t{0}; };
    table.ground_truth_path = [](unisim_source*) { return ""; };
    table.message = [](unisim_source*) { return ""; };
    table.destroy = [](unisim_source*) {};
  }
};

struct RunTimes {
  double p50_ms;
  double p95_ms;
  double max_ms;
  int64_t late;
  int64_t dropped;
  int64_t frames_dropped;
};

RunTimes run_once(const simulator::World& world, const LanesSettings& settings, double window_s) {
  TimedPredictor predictor(world, kSeed, {settings.pair_ms / 1e3, window_s, settings.busy});
  BlankSource source(int64_t{settings.keyframes} * kStride);
  pipeline::Options options;
  options.keyframes.stride = kStride;
  options.realtime = true;
  unisim_config config;
  if (unisim_config_init(&config, sizeof config) != UNISIM_OK) {
    throw tools::Failure(tools::kExitOther, "unisim_config_init failed");
  }
  config.max_keyframes = settings.keyframes + 1;
  pipeline::Pipeline run(options, &source.table, predictor.table(), config, {});
  const pipeline::Result& result = run.run();
  if (result.outcome != pipeline::Outcome::kFinished) {
    throw tools::Failure(tools::kExitOther, "lanes: " + result.message);
  }
  const pipeline::LatencyHistogram& live = result.times.track_total;
  return {live.percentile_ms(0.5), live.percentile_ms(0.95), live.max_ms(),
          result.lanes.late,       result.lanes.dropped,     result.progress.frames_dropped};
}

Json to_json(const RunTimes& times) {
  return {{"p50_ms", times.p50_ms},           {"p95_ms", times.p95_ms},
          {"max_ms", times.max_ms},           {"windows_late", times.late},
          {"windows_dropped", times.dropped}, {"frames_dropped", times.frames_dropped}};
}

}  // namespace

int lanes_command(const LanesSettings& settings) {
  const simulator::World world =
      simulator::make_world(simulator::WorldKind::kWalk, settings.keyframes, kSeed);
  std::vector<double> ratios;
  Json runs = Json::array();
  for (int32_t k = 0; k < settings.repeat; ++k) {
    const RunTimes instant = run_once(world, settings, 0.0);
    const RunTimes slow = run_once(world, settings, settings.window_s);
    ratios.push_back(slow.p95_ms / instant.p95_ms);
    runs.push_back({{"instant", to_json(instant)}, {"slow", to_json(slow)}});
  }
  print_result({{"keyframes", settings.keyframes},
                {"pair_ms", settings.pair_ms},
                {"window_s", settings.window_s},
                {"windows", settings.busy ? "computed here" : "computed elsewhere"},
                {"runs", runs},
                {"p95_over_instant", drivers::median(&ratios)}},
               settings.json);
  return tools::kExitDone;
}

}  // namespace unisim::bench
