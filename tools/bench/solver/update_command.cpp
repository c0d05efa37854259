// SPDX-License-Identifier: MIT
// unisim-bench updates: live updates of a pose graph from a file.
#include "tools/bench/solver/update_command.hpp"

#include "tools/bench/times.hpp"
#include "tools/common/failure.hpp"
#include "tools/common/heap_counter.hpp"

namespace unisim::bench {

int update_command(const UpdateSettings& settings) {
  const PoseGraph graph = read_pose_graph(settings.graph);
  const UpdateRun run = run_updates(graph, settings, tools::heap_counter());
  const Json result = {{"graph", settings.graph},
                       {"keyframes", run.keyframes},
                       {"from", settings.from},
                       {"iterations", settings.iterations},
                       {"least_move", settings.least_move},
                       {"relinearize", settings.relinearize},
                       {"heap_calls", run.heap_calls},
                       {"update_ms", times_json(run.update_ms)},
                       {"loop_update_ms", times_json(run.loop_update_ms)},
                       {"cost", run.cost},
                       {"cost_over_batch", run.cost / run.batch_cost}};
  print_result(result, settings.json);
  return tools::kExitDone;
}

}  // namespace unisim::bench
