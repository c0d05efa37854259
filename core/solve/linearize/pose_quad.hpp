// SPDX-License-Identifier: MIT
// Four pose edges of one shape and where their blocks go.
#pragma once

#include <cstdint>

#include "core/base/isa.hpp"
#include "core/solve/factor/block.hpp"

namespace unisim {

/// Formula of the edges in a quad.
enum class QuadShape : int8_t {
  kOneMeasurement,   ///< log((A P)^-1 B)
  kTwoMeasurements,  ///< log((A P)^-1 (B Q))
  kChain,            ///< log(P^-1 A^-1 B) with a full information
  kRigid             ///< the same without logarithm: rigid.hpp
};
inline constexpr int kQuadShapes = 4;

/// Arrays of Eigen types by their numbers: a Sim3 is x y z w of the quaternion, translation, scale.
struct PoseQuad {
  static constexpr int kEdges = 4;

  QuadShape shape = QuadShape::kOneMeasurement;
  bool a_is_later = false;     ///< rows of the off-diagonal blocks are those of node a, else of b
  bool gradient_only = false;  ///< nothing is added to the blocks
  const double* A[kEdges];
  const double* B[kEdges];
  const double* P[kEdges];
  const double* Q[kEdges];       ///< kTwoMeasurements only
  const double* Lambda[kEdges];  ///< 7x7, kChain and kRigid only
  double weight[kEdges];
  double delta[kEdges];          ///< width of the kernel, infinite: none
  double geman_mcclure[kEdges];  ///< 1: that kernel, 0: Huber
  // Never null: what an edge has no place for goes to a block nobody reads.
  Block* H_aa[kEdges];
  Block* H_bb[kEdges];
  Block* H_ab[kEdges];
  double* g_a[kEdges];
  double* g_b[kEdges];
  double* cost[kEdges];  ///< rho(u) of each edge, overwritten
};

UNISIM_EACH_ISA(void add_pose_quad(const PoseQuad& quad);)

/// Adds w J'J (or not) and w J'e of four edges to their blocks, in the order of the quad. Of
/// diagonal blocks only the lower triangle has a meaning. Weight 0 makes an edge that adds nothing.
inline void add_pose_quad(const PoseQuad& quad) { UNISIM_DISPATCH(add_pose_quad(quad)); }

}  // namespace unisim
