// SPDX-License-Identifier: MIT
// Where the part that each edge has in H was linearised.
#include "core/solve/linearize/linearization_points.hpp"

#include <algorithm>
#include <cmath>

namespace unisim {
namespace {

// Relative change of a robust weight that is worth linearising anew.
constexpr double kWeightTolerance = 0.2;

/// About the largest component of log(D^-1 E), for small ones.
double difference(const Sim3& D, const Sim3& E) {
  const double sign = D.q.dot(E.q) < 0.0 ? -1.0 : 1.0;
  const double rotation = 2.0 * (E.q.coeffs() - sign * D.q.coeffs()).cwiseAbs().maxCoeff();
  const double translation = (E.t - D.t).cwiseAbs().maxCoeff();
  const double length = D.t.cwiseAbs().maxCoeff();
  return std::max({rotation, translation / std::max(D.s, length), std::abs(E.s - D.s) / D.s});
}

}  // namespace

bool LinearizationPoints::follows(const Graph& graph, int32_t id, double cost, double tolerance) {
  if (states_[id] == State::kUnknown) return false;
  const Edge& edge = graph.edge(id);
  const double weight = unisim::robust_weight(edge.kernel, cost);
  if (std::abs(weight - weight_[id]) > kWeightTolerance * weight_[id]) return false;
  if (is_pose_factor(edge.kind)) {  // scale edges are linear
    const Sim3 D = between(graph.pose(edge.a), graph.pose(edge.b));
    if (difference(relative_[id], D) > tolerance) return false;
  }
  states_[id] = State::kElsewhere;
  return true;
}

void LinearizationPoints::set(const Graph& graph, int32_t id) {
  const Edge& edge = graph.edge(id);
  if (is_pose_factor(edge.kind)) {
    relative_[id] = between(graph.pose(edge.a), graph.pose(edge.b));
  }
  states_[id] = State::kNew;
}

void LinearizationPoints::set_cost(const Graph& graph, int32_t id, double cost) {
  weight_[id] = unisim::robust_weight(graph.edge(id).kernel, cost);
  states_[id] = State::kHere;
}

}  // namespace unisim
