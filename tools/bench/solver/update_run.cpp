// SPDX-License-Identifier: MIT
// A pose graph that arrives piece by piece.
#include "tools/bench/solver/update_run.hpp"

#include <algorithm>

#include "tools/bench/process.hpp"
#include "tools/bench/solver/problem.hpp"
#include "tools/common/failure.hpp"

namespace unisim::bench {
namespace {

// Nodes between two ends of a submap beyond which it closes a loop: three windows.
constexpr int32_t kLoopSpan = 48;
// An order made piece by piece fills more than one made for the whole graph.
constexpr int32_t kFillMargin = 3;

class Arrival {
 public:
  Arrival(const PoseGraph& source, const UpdateSettings& settings, const pipeline::HeapWatch& heap)
      : source_(source),
        heap_(heap),
        problem_(Problem::empty(source, kFillMargin * needed_factor_blocks(source))),
        edges_of_(source.nodes.size()) {
    options_.max_iterations = settings.iterations;
    options_.least_move = settings.least_move;
    options_.relinearize = settings.relinearize;
    for (const FileEdge& edge : source.edges) {
      edges_of_[static_cast<size_t>(std::max(edge.a, edge.b))].push_back(&edge);
    }
  }

  /// @return whether it closes a loop
  bool add(size_t place) {
    FileNode node = source_.nodes[place];
    if (before_ >= 0) {
      const Sim3& guess = source_.nodes[static_cast<size_t>(before_)].T_world_node;
      node.T_world_node = problem_.graph().pose(before_) * between(guess, node.T_world_node);
    }
    problem_.add_node(node);
    int32_t oldest = static_cast<int32_t>(place);
    for (const FileEdge* edge : edges_of_[place]) {
      problem_.add_edge(source_, *edge);
      oldest = std::min({oldest, edge->a, edge->b});
    }
    if (!node.submap) before_ = static_cast<int32_t>(place);
    return static_cast<int32_t>(place) - oldest > kLoopSpan;
  }

  /// @return CPU time [ms]
  double optimize(UpdateRun* run) {
    LmReport report;
    const int64_t calls_before = heap_.calls();
    const double start = process_cpu_ms();
    Status status = Status::kOk;
    {
      const pipeline::InsideLibrary inside(heap_);
      status = problem_.solver().optimize(&problem_.graph(), options_, &report);
    }
    const double elapsed = process_cpu_ms() - start;
    run->heap_calls += heap_.calls() - calls_before;
    run->cost = report.final_cost;
    if (!is_ok(status)) {
      throw tools::Failure(tools::kExitLimit,
                           "an update was not solved: the graph is singular or "
                           "its factor larger than declared");
    }
    return elapsed;
  }

  double batch_cost() {
    options_.max_iterations = 100;
    options_.least_move = 0.0;
    options_.relinearize = 0.0;
    UpdateRun run;
    optimize(&run);
    return run.cost;
  }

 private:
  const PoseGraph& source_;
  const pipeline::HeapWatch& heap_;
  Problem problem_;
  LmOptions options_;
  std::vector<std::vector<const FileEdge*>> edges_of_;
  int32_t before_ = -1;  // keyframe that arrived last
};

}  // namespace

UpdateRun run_updates(const PoseGraph& source, const UpdateSettings& settings,
                      const pipeline::HeapWatch& heap) {
  UpdateRun run;
  Arrival arrival(source, settings, heap);
  for (size_t place = 0; place < source.nodes.size(); ++place) {
    const bool is_loop = arrival.add(place);
    if (!source.nodes[place].submap) {
      ++run.keyframes;
      continue;
    }
    const double elapsed = arrival.optimize(&run);
    if (run.keyframes < settings.from) continue;
    (is_loop ? run.loop_update_ms : run.update_ms).push_back(elapsed);
  }
  run.batch_cost = arrival.batch_cost();
  return run;
}

}  // namespace unisim::bench
