// SPDX-License-Identifier: MIT
// unisim-bench window: a long walk through a session.
#include "tools/bench/walk/walk_command.hpp"

#include <algorithm>

#include "tools/bench/times.hpp"
#include "tools/common/failure.hpp"
#include "tools/common/heap_counter.hpp"

namespace unisim::bench {
namespace {

constexpr size_t kTail = 100;  // updates at the end of the walk that are shown apart

std::vector<double> tail(const std::vector<double>& times) {
  const size_t count = std::min(kTail, times.size());
  return {times.end() - static_cast<std::ptrdiff_t>(count), times.end()};
}

Json result_json(const WalkSettings& settings, const WalkResult& result) {
  return {{"keyframes", result.keyframes},
          {"seed", settings.seed},
          {"window_submaps", settings.window_submaps},
          {"skeleton_capacity", settings.skeleton_capacity},
          {"submaps", result.submaps},
          {"submaps_refused", result.submaps_refused},
          {"loops", result.loops},
          {"loops_refused", result.loops_refused},
          {"loops_out_of_reach", result.loops_out_of_reach},
          {"loop_suspensions", result.loop_suspensions},
          {"loop_returns", result.loop_returns},
          {"loops_dropped", result.loops_dropped},
          {"arena_bytes", result.arena_bytes},
          {"depth_bytes", result.depth_bytes},
          {"heap_calls_after_init", result.heap_calls},
          {"update_ms", times_json(result.update_ms)},
          {"update_tail_ms", times_json(tail(result.update_ms))},
          {"loop_update_ms", times_json(result.loop_update_ms)},
          {"loop_update_tail_ms", times_json(tail(result.loop_update_ms))},
          {"snapshot_bytes", result.snapshot.bytes},
          {"save_ms", result.snapshot.save_ms},
          {"load_ms", result.snapshot.load_ms},
          {"live_ate_m", result.live_ate_m},
          {"ate_m", result.ate_m},
          {"ate_over_batch",
           result.ate_over_batch > 0.0 ? Json(result.ate_over_batch) : Json(nullptr)}};
}

}  // namespace

int walk_command(const WalkSettings& settings, bool json) {
  const Json result = result_json(settings, run_walk(settings, tools::heap_counter()));
  print_result(result, json);
  return tools::kExitDone;
}

}  // namespace unisim::bench
