// SPDX-License-Identifier: MIT
// Levenberg-Marquardt on a Sim(3) graph.
#include "core/solve/lm.hpp"

#include <algorithm>
#include <cmath>

namespace unisim {
namespace {

constexpr double kLowestLambda = 1e-12;
constexpr double kHighestLambda = 1e12;
// An order that was renewed in parts is given up when it fills this much more than a whole one.
constexpr double kWornOrder = 1.25;

bool valid_options(const LmOptions& o) {
  return o.max_iterations >= 0 && o.initial_lambda > 0.0 && o.initial_lambda <= kHighestLambda &&
         o.cost_tolerance >= 0.0 && o.step_tolerance >= 0.0 && o.least_move >= 0.0 &&
         o.relinearize >= 0.0 && o.max_log_scale_step > 0.0;
}

void tell(const LmObserver& observer, LmPhase phase, const LmReport& report) {
  if (observer.enter != nullptr) {
    observer.enter(phase, report.iterations, report.final_cost, observer.user);
  }
}

// Nielsen's rule: damping falls smoothly with the gain ratio rho, grows ever faster on failures.
struct Damping {
  double lambda;
  double growth = 2.0;

  void accept(double rho) {
    const double m = 2.0 * rho - 1.0;
    lambda = std::max(kLowestLambda, lambda * std::max(1.0 / 3.0, 1.0 - m * m * m));
    growth = 2.0;
  }
  void reject() {
    lambda *= growth;
    growth *= 2.0;
  }
  bool exhausted() const { return !(lambda <= kHighestLambda); }
};

}  // namespace

LevenbergMarquardt::LevenbergMarquardt(Arena& arena, const SolverCapacity& capacity)
    : pattern_(arena, capacity),
      equations_(arena, capacity),
      cholesky_(arena, capacity),
      forward_(arena.take<BlockVector>(capacity.nodes)),
      step_(arena.take<BlockVector>(capacity.nodes)),
      saved_(arena.take<Sim3>(capacity.nodes)) {}

// Marks the columns whose part of the gradient has changed, those of changed nodes and next to a
// node that has moved; and whose part of H has.
void LevenbergMarquardt::note_changes(const Graph& graph) {
  if (graph.revision() == seen_revision_) return;
  int32_t moved = 0;
  for (int32_t id = 0; id < graph.node_end(); ++id) {
    const int32_t column = pattern_.column_of_node(id);
    const uint8_t changes = graph.changes_since(id, seen_revision_);
    if (changes == 0 || column < 0) continue;
    moved += (changes & kNodeMoved) != 0 ? 1 : 0;
    equations_.mark_changed(column);
    if ((changes & kNodeRelinked) != 0) cholesky_.mark_stale(column);
  }
  if (moved == pattern_.columns() && relinearize_ == 0.0) {  // the usual case of a whole graph
    cholesky_.mark_all_stale();
    equations_.forget_points();
    seen_revision_ = graph.revision();
    return;
  }
  for (int32_t id = 0; id < graph.edge_end(); ++id) {
    const Edge& edge = graph.edge(id);
    if (edge.alive) note_changed_edge(graph, id);
  }
  seen_revision_ = graph.revision();
}

void LevenbergMarquardt::note_changed_edge(const Graph& graph, int32_t id) {
  const Edge& edge = graph.edge(id);
  const uint8_t at_a = graph.changes_since(edge.a, seen_revision_);
  const uint8_t at_b = graph.changes_since(edge.b, seen_revision_);
  const uint8_t any = at_a | at_b;
  const bool moved = (any & kNodeMoved) != 0;
  // An edge that is new or has new numbers has relinked both of its ends.
  const bool renewed = (at_a & at_b & kNodeRelinked) != 0 || (any & kNodeHeld) != 0;
  if (!moved && !renewed) return;
  const bool holds =
      !renewed && relinearize_ > 0.0 && equations_.point_holds(graph, id, relinearize_);
  if (!holds) equations_.forget_point(id);
  for (const int32_t node : {edge.a, edge.b}) {
    const int32_t column = pattern_.column_of_node(node);
    if (column < 0) continue;
    equations_.mark_changed(column);
    if (!holds) cholesky_.mark_stale(column);
  }
}

// What is fixed decides the structure.
void LevenbergMarquardt::hold_skeleton(bool hold) {
  if (hold != pattern_.holds_skeleton()) held_otherwise_ = true;
  pattern_.hold_skeleton(hold);
}

Status LevenbergMarquardt::prepare(const Graph& graph, const LmObserver& observer) {
  const bool known = structure_revision_ != 0;
  if (known) note_changes(graph);
  if (graph.structure_revision() == structure_revision_ && !held_otherwise_) return Status::kOk;
  structure_revision_ = 0;
  undamped_revision_ = 0;
  if (!known || held_otherwise_ || !reorder_changed(graph, observer)) {
    tell(observer, LmPhase::kOrder, LmReport());
    Status status = pattern_.build(graph);
    if (!is_ok(status)) return status;
    tell(observer, LmPhase::kAnalyze, LmReport());
    status = cholesky_.analyze(pattern_.column_start(), pattern_.rows());
    if (!is_ok(status)) return status;
    fill_ = fill_per_column();
    if (!known) equations_.forget_points();
    equations_.mark_all_changed();
    seen_revision_ = graph.revision();
  }
  structure_revision_ = graph.structure_revision();
  held_otherwise_ = false;
  return Status::kOk;
}

double LevenbergMarquardt::fill_per_column() const {
  return static_cast<double>(cholesky_.needed_blocks()) / pattern_.columns();
}

// @return false when a new order of all columns is as cheap, or better in the long run
bool LevenbergMarquardt::reorder_changed(const Graph& graph, const LmObserver& observer) {
  if (fill_per_column() > kWornOrder * fill_) return false;
  tell(observer, LmPhase::kOrder, LmReport());
  const KeptOrder kept = cholesky_.keep();
  if (2 * kept.columns.size() < pattern_.columns()) return false;
  if (!is_ok(pattern_.rebuild(graph, kept))) return false;
  tell(observer, LmPhase::kAnalyze, LmReport());
  equations_.keep(kept.columns);
  for (int32_t i = 0; i < kept.columns.size(); ++i) forward_[i] = forward_[kept.columns[i]];
  return is_ok(cholesky_.reanalyze(pattern_.column_start(), pattern_.rows()));
}

double LevenbergMarquardt::linearize(const Graph& graph) {
  note_changes(graph);
  for (int32_t j = 0; j < pattern_.columns(); ++j) {
    if (equations_.has_changed(j)) cholesky_.mark_stale(j, Staleness::kRightSide);
  }
  return equations_.linearize(graph, pattern_, cholesky_.begin_assembly(), relinearize_ > 0.0);
}

double LevenbergMarquardt::linearize_all(const Graph& graph) {
  cholesky_.mark_all_stale();
  equations_.forget_points();
  return linearize(graph);
}

Status LevenbergMarquardt::optimize(Graph* graph, const LmOptions& options, LmReport* report) {
  *report = LmReport();
  if (!valid_options(options)) return Status::kInvalidArgument;
  if (graph->edge_count() == 0) return Status::kNotReady;
  relinearize_ = options.relinearize;
  hold_skeleton(options.hold_skeleton);
  const Status status = prepare(*graph, options.observer);
  report->factor_blocks = cholesky_.needed_blocks();
  if (!is_ok(status)) return status;
  undamped_revision_ = 0;
  tell(options.observer, LmPhase::kLinearize, *report);
  report->initial_cost = linearize(*graph);
  report->final_cost = report->initial_cost;
  if (!std::isfinite(report->initial_cost)) {
    report->stop = LmStop::kNoDescent;
    return Status::kNumerical;
  }
  tell(options.observer, LmPhase::kAccept, *report);
  report->stop = iterate(graph, options, report);
  tell(options.observer, LmPhase::kEnd, *report);
  const bool good = report->stop == LmStop::kConverged || report->stop == LmStop::kBudget;
  return good ? Status::kOk : Status::kNumerical;
}

// The trial is linearised at once: an accepted step, the usual case, then needs no pass of its own
// for the cost.
LmStop LevenbergMarquardt::iterate(Graph* graph, const LmOptions& options, LmReport* report) {
  Damping damping{options.initial_lambda};
  bool factored = true;
  for (; report->iterations < options.max_iterations; ++report->iterations) {
    report->lambda = damping.lambda;
    if (damping.exhausted()) return factored ? LmStop::kNoDescent : LmStop::kNotPositive;
    factored = find_step(options, *report);
    if (!factored) {
      report->bad_node = pattern_.node_of_column(std::max<int32_t>(cholesky_.bad_column(), 0));
      tell(options.observer, LmPhase::kLinearize, *report);
      linearize_all(*graph);
      damping.reject();
      continue;
    }
    const double cost = report->final_cost;
    const double predicted = predicted_decrease(damping.lambda);
    const bool moved = apply_step(graph, options.least_move);
    tell(options.observer, LmPhase::kLinearize, *report);
    const double trial = moved ? linearize(*graph) : cost;
    if (moved && std::isfinite(trial) && trial <= cost) {
      damping.accept(predicted > 0.0 ? (cost - trial) / predicted : 1.0);
      report->final_cost = trial;
      ++report->accepted;
      tell(options.observer, LmPhase::kAccept, *report);
      if (cost - trial <= options.cost_tolerance * cost || step_size_ <= options.step_tolerance) {
        ++report->iterations;
        return LmStop::kConverged;
      }
      continue;
    }
    tell(options.observer, LmPhase::kStep, *report);
    restore_poses(graph, options.least_move);
    // Steps this small fail by roundoff only: the cost has no lower digits left.
    if (step_size_ <= options.step_tolerance) {
      ++report->iterations;
      return LmStop::kConverged;
    }
    tell(options.observer, LmPhase::kLinearize, *report);
    linearize_all(*graph);
    damping.reject();
  }
  return factored ? LmStop::kBudget : LmStop::kNotPositive;
}

// Factorises H and brings L^-1 (-g) up to date.
Status LevenbergMarquardt::factorize(double lambda) {
  const Span<const BlockVector> g = equations_.gradient();
  for (int32_t j = 0; j < pattern_.columns(); ++j) {
    if (cholesky_.staleness(j) == Staleness::kNone) continue;
    for (int d = 0; d < kBlockRows; ++d) forward_[j].v[d] = -g[j].v[d];
  }
  return cholesky_.factorize(lambda, forward_);
}

bool LevenbergMarquardt::find_step(const LmOptions& options, const LmReport& report) {
  tell(options.observer, LmPhase::kFactorize, report);
  if (!is_ok(factorize(report.lambda))) return false;
  tell(options.observer, LmPhase::kSolve, report);
  const Span<BlockVector> step = step_.subspan(0, pattern_.columns());
  for (int32_t j = 0; j < step.size(); ++j) step[j] = forward_[j];
  cholesky_.backward(step, options.least_move);
  tell(options.observer, LmPhase::kStep, report);
  double largest = 0.0;
  double log_scale = 0.0;
  bool finite = true;
  for (const BlockVector& dx : step) {
    for (int d = 0; d < kTangentDim; ++d) {
      finite = finite && std::isfinite(dx.v[d]);
      largest = std::max(largest, std::abs(dx.v[d]));
    }
    log_scale = std::max(log_scale, std::abs(dx.v[kLogScale]));
  }
  if (!finite) return false;
  shortened_ = std::min(1.0, options.max_log_scale_step / log_scale);
  for (BlockVector& dx : step) {
    for (double& value : dx.v) value *= shortened_;
  }
  step_size_ = shortened_ * largest;
  return true;
}

// -g' dx - dx' H dx / 2. The solution d fulfils (H + lambda diag(H)) d = -g, so that for dx = k d
// the product H dx is not needed: dx' H dx = -k g' dx - lambda dx' diag(H) dx.
double LevenbergMarquardt::predicted_decrease(double lambda) const {
  const Span<const BlockVector> g = equations_.gradient();
  double along_gradient = 0.0;
  double damping = 0.0;
  for (int32_t j = 0; j < pattern_.columns(); ++j) {
    const BlockVector& dx = step_[j];
    for (int d = 0; d < kTangentDim; ++d) {
      along_gradient -= g[j].v[d] * dx.v[d];
      damping += lambda * cholesky_.H_diagonal(j).v[d] * dx.v[d] * dx.v[d];
    }
  }
  return (1.0 - 0.5 * shortened_) * along_gradient + 0.5 * damping;
}

bool LevenbergMarquardt::stays(int32_t column, double least_move) const {
  return Eigen::Map<const Vec7>(step_[column].v).cwiseAbs().maxCoeff() <= least_move;
}

// False when a pose would leave the range of numbers; poses are then partly moved.
bool LevenbergMarquardt::apply_step(Graph* graph, double least_move) {
  for (int32_t j = 0; j < pattern_.columns(); ++j) {
    saved_[j] = graph->pose(pattern_.node_of_column(j));
  }
  for (int32_t j = 0; j < pattern_.columns(); ++j) {
    if (stays(j, least_move)) continue;
    const Sim3 moved = retract(saved_[j], Eigen::Map<const Vec7>(step_[j].v));
    if (!is_ok(graph->set_pose(pattern_.node_of_column(j), moved))) return false;
  }
  return true;
}

void LevenbergMarquardt::restore_poses(Graph* graph, double least_move) const {
  for (int32_t j = 0; j < pattern_.columns(); ++j) {
    if (stays(j, least_move)) continue;
    const Status status = graph->set_pose(pattern_.node_of_column(j), saved_[j]);
    UNISIM_CHECK(is_ok(status));
    static_cast<void>(status);
  }
}

Status LevenbergMarquardt::factorize_undamped(const Graph& graph) {
  hold_skeleton(false);
  Status status = prepare(graph, LmObserver());
  if (!is_ok(status)) return status;
  undamped_revision_ = 0;
  linearize_all(graph);
  status = factorize(0.0);
  if (!is_ok(status)) return status;
  undamped_revision_ = graph.revision();
  inverted_ = false;
  return Status::kOk;
}

Status LevenbergMarquardt::marginal_covariance(const Graph& graph, int32_t node, Mat7* covariance) {
  if (!graph.has_node(node) || graph.node(node).fixed) return Status::kInvalidArgument;
  if (undamped_revision_ != graph.revision()) {
    const Status status = factorize_undamped(graph);
    if (!is_ok(status)) return status;
  }
  inverted_ = true;
  cholesky_.inverse_block(pattern_.column_of_node(node), step_, covariance);
  return Status::kOk;
}

Status LevenbergMarquardt::begin_product(const Graph& graph, Span<BlockVector>* x) {
  if (undamped_revision_ != graph.revision() || inverted_) {
    const Status status = factorize_undamped(graph);
    if (!is_ok(status)) return status;
  }
  *x = step_.subspan(0, pattern_.columns());
  x->fill(BlockVector());
  return Status::kOk;
}

}  // namespace unisim
