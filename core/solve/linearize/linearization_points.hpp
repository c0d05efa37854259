// SPDX-License-Identifier: MIT
// Where the part that each edge has in H was linearised.
#pragma once

#include <cstdint>

#include "core/base/arena.hpp"
#include "core/graph/graph.hpp"

namespace unisim {

/// Remembers of each edge the relative pose D = A^-1 B of its linearisation: with right
/// perturbations its Jacobians depend on nothing else, so an edge whose ends move together keeps
/// its part of H, however far they go. An edge that is not known was linearised at the present
/// poses.
class LinearizationPoints {
 public:
  LinearizationPoints() = default;
  LinearizationPoints(Arena& arena, int32_t edges)
      : states_(arena.take<State>(edges)),
        relative_(arena.take<Sim3>(edges)),
        weight_(arena.take<double>(edges)) {}

  /// An end of the edge has moved. @return whether its part of H is still good: D has changed by
  /// no more than `tolerance` (share of its length, rad, log-scale) and the weight of its robust
  /// kernel little
  /// @param cost rho(u) when it was last evaluated
  bool follows(const Graph& graph, int32_t id, double cost, double tolerance);
  void forget(int32_t id) { states_[id] = State::kUnknown; }
  void forget_all() { states_.fill(State::kUnknown); }

  /// The edge is being linearised at the present poses.
  void set(const Graph& graph, int32_t id);
  /// What its cost was there, to be said before an end moves.
  void set_cost(const Graph& graph, int32_t id, double cost);
  bool needs_cost(int32_t id) const { return states_[id] == State::kNew; }

  /// Whether the edge was linearised at the present poses.
  bool is_here(int32_t id) const { return states_[id] != State::kElsewhere; }
  bool knows(int32_t id) const { return states_[id] != State::kUnknown; }
  /// Whether the cost that was said is that at the present poses.
  bool cost_holds(int32_t id) const { return states_[id] == State::kHere; }
  /// Of an edge that is known: D, and the weight of its robust kernel.
  const Sim3& relative_pose(int32_t id) const { return relative_[id]; }
  double robust_weight(int32_t id) const { return weight_[id]; }

 private:
  enum class State : uint8_t { kUnknown, kNew, kHere, kElsewhere };
  Span<State> states_;
  Span<Sim3> relative_;
  Span<double> weight_;
};

}  // namespace unisim
