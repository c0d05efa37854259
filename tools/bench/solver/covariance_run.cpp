// SPDX-License-Identifier: MIT
// Covariances of a solved pose graph, measured.
#include "tools/bench/solver/covariance_run.hpp"

#include <vector>

#include "tools/bench/process.hpp"
#include "tools/bench/solver/problem.hpp"
#include "tools/common/failure.hpp"

namespace unisim::bench {
namespace {

void require(Status status) {
  if (is_ok(status)) return;
  throw tools::Failure(tools::kExitLimit,
                       "no covariance: the graph is singular or was not solved; hold one node of "
                       "each connected part");
}

std::vector<int32_t> free_keyframes(const PoseGraph& source) {
  std::vector<int32_t> ids;
  for (size_t id = 0; id < source.nodes.size(); ++id) {
    const FileNode& node = source.nodes[id];
    if (!node.submap && !node.fixed) ids.push_back(static_cast<int32_t>(id));
  }
  return ids;
}

/// A solved graph whose system is not factorised at the poses it has ended at.
class Solved {
 public:
  Solved(const PoseGraph& source, int32_t factor_blocks) : problem_(source, factor_blocks) {
    LmOptions options;
    options.max_iterations = 100;
    require(problem_.solver().optimize(&problem_.graph(), options, &report_));
  }

  const LmReport& report() const { return report_; }

  /// Covariances of these nodes. @return CPU time [ms]
  double read(Span<const int32_t> ids) {
    const double start = process_cpu_ms();
    for (const int32_t id : ids) {
      Mat7 block;
      require(problem_.solver().marginal_covariance(problem_.graph(), id, &block));
      trace_sum += block.trace();
    }
    return process_cpu_ms() - start;
  }

  double trace_sum = 0.0;

 private:
  Problem problem_;
  LmReport report_;
};

}  // namespace

CovarianceRun run_covariance(const PoseGraph& source, const pipeline::HeapWatch& heap) {
  const std::vector<int32_t> ids = free_keyframes(source);
  if (ids.empty()) require(Status::kNotReady);
  const int32_t factor_blocks = needed_factor_blocks(source);
  Solved few(source, factor_blocks);
  Solved all(source, factor_blocks);
  CovarianceRun run;
  run.poses = static_cast<int32_t>(ids.size());
  const Span<const int32_t> every(ids.data(), run.poses);
  run.factor_blocks = all.report().factor_blocks;
  const int64_t calls_before = heap.calls();
  {
    const pipeline::InsideLibrary inside(heap);
    run.first_ms = few.read(every.subspan(run.poses - 1, 1));
    run.another_ms = few.read(every.subspan(run.poses / 2, 1));
    run.all_ms = all.read(every);
  }
  run.heap_calls = heap.calls() - calls_before;
  run.trace_sum = all.trace_sum;
  return run;
}

}  // namespace unisim::bench
