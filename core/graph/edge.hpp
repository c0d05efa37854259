// SPDX-License-Identifier: MIT
// Nodes and edges as the graph stores them, and what an edge contributes to the cost.
#pragma once

#include <cstdint>

#include "core/graph/robust_kernel.hpp"
#include "core/lie/sim3.hpp"

namespace unisim {

/// A skeleton node is a submap whose keyframes have left the graph. A metre has a scale only
/// (metric.hpp).
enum class NodeKind : uint8_t { kKeyframe, kSubmap, kSkeleton, kMetre };

/// Keyframe (T_world_kf) or submap (T_world_submap).
struct Node {
  Sim3 T_world_node;
  uint32_t serial = 0;  ///< grows with each node added: age where ids are used again
  NodeKind kind = NodeKind::kKeyframe;
  bool fixed = false;  ///< pose is held: the node has no columns in the system
  bool alive = false;
};

enum class FactorKind : uint8_t {
  kTwoView,
  kBridge,
  kTie,
  kScaleAnchor,
  kScale,
  kChain,
  kRigid,
  kMetric
};

/// Scale factors have 1 row and read log_ratio; pose factors have 7 (rigid ones 6) and read P (and
/// Q, Lambda).
constexpr bool is_pose_factor(FactorKind kind) {
  return kind != FactorKind::kScaleAnchor && kind != FactorKind::kScale &&
         kind != FactorKind::kMetric;
}

/// The prediction that an edge comes from, or those that were condensed into it.
enum class EdgeOrigin : uint8_t { kPair, kWindow, kLoop };

/// What every edge is given besides its measurement.
struct EdgeWeight {
  double information = 1.0;  ///< > 0, finite
  double multiplier = 1.0;   ///< >= 0, finite
  RobustKernel kernel;
  EdgeOrigin origin = EdgeOrigin::kWindow;
};

/// One factor between nodes a and b. Its cost is rho(u), u = sqrt(information * multiplier) |e|;
/// of chain and rigid factors u = sqrt(information * multiplier * e' Lambda e).
struct Edge {
  int32_t a = -1;
  int32_t b = -1;
  int32_t P = -1;            ///< measurement slot, pose factors only
  int32_t Q = -1;            ///< second measurement slot; -1: identity
  int32_t Lambda = -1;       ///< information slot, chain and rigid factors only
  double log_ratio = 0.0;    ///< c of a scale factor
  double information = 1.0;  ///< weight of the factor kind, > 0
  double multiplier = 1.0;   ///< weight of this edge for its quality, >= 0
  RobustKernel kernel;
  FactorKind kind = FactorKind::kTwoView;
  EdgeOrigin origin = EdgeOrigin::kWindow;
  bool alive = false;
  bool suspended = false;  ///< kept with its place in the system, contributes nothing

  EdgeWeight given_weight() const { return {information, multiplier, kernel, origin}; }
  double weight() const { return information * multiplier; }
  bool active() const { return alive && !suspended; }
};

}  // namespace unisim
