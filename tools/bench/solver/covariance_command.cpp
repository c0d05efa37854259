// SPDX-License-Identifier: MIT
// unisim-bench covariance: marginal covariances of a pose graph from a file.
#include "tools/bench/solver/covariance_command.hpp"

#include <vector>

#include "tools/bench/times.hpp"
#include "tools/common/failure.hpp"
#include "tools/common/heap_counter.hpp"

namespace unisim::bench {

int covariance_command(const CovarianceSettings& settings) {
  const PoseGraph graph = read_pose_graph(settings.graph);
  CovarianceRun run;
  std::vector<double> first_ms, another_ms, all_ms;
  for (int32_t i = 0; i < settings.repeat; ++i) {
    run = run_covariance(graph, tools::heap_counter());
    first_ms.push_back(run.first_ms);
    another_ms.push_back(run.another_ms);
    all_ms.push_back(run.all_ms);
  }
  const Json result = {{"graph", settings.graph},
                       {"poses", run.poses},
                       {"factor_blocks", run.factor_blocks},
                       {"heap_calls", run.heap_calls},
                       {"first_ms", times_json(first_ms)},
                       {"another_ms", times_json(another_ms)},
                       {"all_ms", times_json(all_ms)},
                       {"trace_sum", run.trace_sum}};
  print_result(result, settings.json);
  return tools::kExitDone;
}

}  // namespace unisim::bench
