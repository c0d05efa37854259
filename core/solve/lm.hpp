// SPDX-License-Identifier: MIT
// Levenberg-Marquardt on a Sim(3) graph.
#pragma once

#include <cstdint>

#include "core/base/arena.hpp"
#include "core/base/status.hpp"
#include "core/graph/graph.hpp"
#include "core/solve/factor/block_cholesky.hpp"
#include "core/solve/linearize/normal_equations.hpp"
#include "core/solve/lm_observer.hpp"
#include "core/solve/order/block_pattern.hpp"

namespace unisim {

struct LmOptions {
  int32_t max_iterations = 10;   ///< accepted and rejected steps together, >= 0
  double initial_lambda = 1e-6;  ///< damping lambda diag(H), > 0
  double cost_tolerance = 1e-7;  ///< stop at this relative change of the cost
  double step_tolerance = 1e-7;  ///< stop when no component of the step is larger
  double least_move = 0.0;       ///< nodes whose step has no larger component stay where they are:
                                 ///< what only they see is neither linearised nor factorised anew
  double relinearize = 0.0;    ///< edges whose relative pose has changed by no more since they were
                               ///< linearised keep their part of H; the gradient stays exact
  bool hold_skeleton = false;  ///< skeleton nodes stay where they are
  double max_log_scale_step = 1.0;  ///< larger log-scale: the whole step is shortened
  LmObserver observer;  ///< called on the caller's thread; may not touch the solver or the graph
};

/// Why an optimisation ended; numbers of UNISIM_STOP_*.
enum class LmStop : int32_t {
  kConverged = 0,
  kBudget = 1,
  kNoDescent = 2,   ///< damping at its limit without a lower cost
  kNotPositive = 3  ///< damping at its limit or iterations used up without a factor
};

struct LmReport {
  LmStop stop = LmStop::kConverged;
  int32_t iterations = 0;  ///< accepted and rejected steps, failed factorisations included
  int32_t accepted = 0;
  int64_t factor_blocks = 0;  ///< blocks of L, diagonal included; the needed number on kCapacity
  int32_t bad_node = -1;      ///< node of the last pivot that failed, -1 if none
  double initial_cost = 0.0;
  double final_cost = 0.0;
  double lambda = 0.0;  ///< damping at the end
};

/// Minimises the cost of a graph over its free nodes, in memory carved at construction.
///
/// Serves one graph and keeps its last system H dx = g with the factor L of H, one column per free
/// node. A column of L depends on the edges of its node and on columns eliminated before it, so a
/// change spreads along one path each: from the column of the node up to the root of the
/// elimination tree (solve/ordering.hpp). Only columns on such paths are linearised, ordered and
/// factorised anew, all others are still right.
class LevenbergMarquardt {
 public:
  LevenbergMarquardt() = default;
  LevenbergMarquardt(Arena& arena, const SolverCapacity& capacity);

  /// Optimise from the present poses; they end at the last accepted step, whatever happens.
  /// @return kOk (converged or budget used up); kNumerical for the other stops; kNotReady without a
  ///         free node or an edge; kCapacity when the graph or its factor is larger than declared
  ///         (poses unchanged, report->factor_blocks says what the factor needs)
  Status optimize(Graph* graph, const LmOptions& options, LmReport* report);

  /// Marginal covariance of a free node at the present poses: its 7x7 block of H^-1, in the node's
  /// tangent space. Costs a factorisation when the graph has changed since the last call, then what
  /// of the inverse lies above the node in the elimination tree and is not there yet.
  /// @return kOk; kInvalidArgument for an unknown or fixed node; kNumerical when H is singular;
  ///         kCapacity and kNotReady as optimize()
  Status marginal_covariance(const Graph& graph, int32_t node, Mat7* covariance);

  /// x := H^-1 x at the present poses, in two steps: begin_product() factorises H when the graph
  /// has changed since and gives x, zero, one vector for each column of pattern(); the caller fills
  /// it, finish_product() turns it into the product.
  /// @return as marginal_covariance()
  Status begin_product(const Graph& graph, Span<BlockVector>* x);
  void finish_product(Span<BlockVector> x) const { cholesky_.solve(x); }

  /// The analysed structure; valid after a successful call of those above.
  const BlockPattern& pattern() const { return pattern_; }

  /// The next graph is another one: nothing of the last order and factor is kept.
  void forget() {
    structure_revision_ = 0;
    relinearize_ = 0.0;
    undamped_revision_ = 0;
  }

 private:
  void hold_skeleton(bool hold);
  double linearize(const Graph& graph);
  double linearize_all(const Graph& graph);
  void note_changes(const Graph& graph);
  void note_changed_edge(const Graph& graph, int32_t id);
  Status prepare(const Graph& graph, const LmObserver& observer);
  bool reorder_changed(const Graph& graph, const LmObserver& observer);
  double fill_per_column() const;
  LmStop iterate(Graph* graph, const LmOptions& options, LmReport* report);
  Status factorize(double lambda);
  Status factorize_undamped(const Graph& graph);
  bool find_step(const LmOptions& options, const LmReport& report);
  double predicted_decrease(double lambda) const;
  bool apply_step(Graph* graph, double least_move);
  void restore_poses(Graph* graph, double least_move) const;
  bool stays(int32_t column, double least_move) const;

  BlockPattern pattern_;
  NormalEquations equations_;
  BlockCholesky cholesky_;
  Span<BlockVector> forward_;  // L^-1 (-g)
  Span<BlockVector> step_;
  Span<Sim3> saved_;
  bool held_otherwise_ = false;      // the skeleton counted as free before and is held now, or so
  double relinearize_ = 0.0;         // of the present options
  double fill_ = 0.0;                // blocks per column of the last order of all columns
  double step_size_ = 0.0;           // largest component of step_
  double shortened_ = 1.0;           // factor by which step_ is shorter than the solution
  uint64_t seen_revision_ = 0;       // of the graph, up to which its changes have been taken in
  uint64_t structure_revision_ = 0;  // of the analysed graph
  uint64_t undamped_revision_ = 0;   // of the graph whose H the undamped factor holds
  bool inverted_ = false;            // part of that factor has been turned into the inverse
};

}  // namespace unisim
