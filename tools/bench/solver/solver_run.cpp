// SPDX-License-Identifier: MIT
// One optimisation of a graph file, measured.
#include "tools/bench/solver/solver_run.hpp"

#include "tools/bench/process.hpp"
#include "tools/bench/solver/problem.hpp"

namespace unisim::bench {
namespace {

// Gives the time between two calls of the solver to the phase that the first one began.
class Stopwatch {
 public:
  explicit Stopwatch(SolverRun* run) : run_(run) {}

  LmObserver observer() { return {&Stopwatch::enter, this}; }
  void start() { start_ms_ = last_ms_ = process_cpu_ms(); }
  double elapsed_ms() const { return last_ms_ - start_ms_; }
  void stop() { last_ms_ = process_cpu_ms(); }

 private:
  static void enter(LmPhase phase, int32_t, double cost, void* user) {
    Stopwatch& self = *static_cast<Stopwatch*>(user);
    const double now = process_cpu_ms();
    self.run_->phase_ms[static_cast<size_t>(self.phase_)] += now - self.last_ms_;
    self.last_ms_ = now;
    if (phase == LmPhase::kAccept) self.run_->trace.emplace_back(self.elapsed_ms(), cost);
    if (phase != LmPhase::kEnd) self.phase_ = phase;
  }

  SolverRun* run_;
  LmPhase phase_ = LmPhase::kOrder;
  double start_ms_ = 0.0;
  double last_ms_ = 0.0;
};

}  // namespace

SolverRun run_solver(const PoseGraph& source, int32_t factor_blocks, LmOptions options,
                     const pipeline::HeapWatch& heap) {
  SolverRun run;
  run.trace.reserve(static_cast<size_t>(options.max_iterations) + 1);
  const double before_setup = process_cpu_ms();
  Problem problem(source, factor_blocks);
  run.setup_ms = process_cpu_ms() - before_setup;
  run.arena_bytes = problem.arena_bytes();
  run.first_cost = problem.graph().cost();

  Stopwatch watch(&run);
  options.observer = watch.observer();
  const int64_t calls_before = heap.calls();
  {
    const pipeline::InsideLibrary inside(heap);
    watch.start();
    run.status = problem.solver().optimize(&problem.graph(), options, &run.report);
    watch.stop();
  }
  run.heap_calls = heap.calls() - calls_before;
  run.solve_ms = watch.elapsed_ms();
  run.cost = problem.graph().cost();
  run.resident_peak_kb = peak_resident_kb();
  return run;
}

}  // namespace unisim::bench
