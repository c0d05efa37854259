// SPDX-License-Identifier: MIT
// Four pose edges at once into the normal equations; vectorised.
#include "core/solve/linearize/pose_quad.hpp"

#include "core/graph/relative_pose_pack.hpp"
#include "core/graph/rigid_pack.hpp"

namespace unisim {
namespace UNISIM_ISA {
namespace {

static_assert(PoseQuad::kEdges % kPackLanes == 0, "a lane per edge");

// Lower triangle and the block above it, of a symmetric matrix in column-major order.
UNISIM_ALWAYS_INLINE PackSymmetric gather_symmetric(const double* const from[kPackLanes]) {
  constexpr int kRows = kTangentDim;
  const auto at = [from](int row, int column) { return gather(from, column * kRows + row); };
  const auto row = [&at](int r, int c) { return Pack3{at(r, c), at(r, c + 1), at(r, c + 2)}; };
  return {{{row(0, 0), row(1, 0), row(2, 0)}}, {{row(0, 3), row(1, 3), row(2, 3)}},
          {{row(3, 3), row(4, 3), row(5, 3)}}, {at(0, 6), at(1, 6), at(2, 6)},
          {at(3, 6), at(4, 6), at(5, 6)},      at(6, 6)};
}

struct Targets {
  UNISIM_ALWAYS_INLINE explicit Targets(Block* const blocks[kPackLanes]) {
    for (int lane = 0; lane < kPackLanes; ++lane) v[lane] = blocks[lane]->v;
  }
  double* v[kPackLanes];
};

UNISIM_ALWAYS_INLINE void add_vector(double* const to[kPackLanes], const PackVector& g) {
  scatter_add_four(g.t.x, g.t.y, g.t.z, g.r.x, to, 0);
  scatter_add_four(g.r.y, g.r.z, g.s, splat(0.0), to, 4);
}

UNISIM_ALWAYS_INLINE void subtract_vector(double* const from[kPackLanes], const PackVector& g) {
  scatter_subtract_four(g.t.x, g.t.y, g.t.z, g.r.x, from, 0);
  scatter_subtract_four(g.r.y, g.r.z, g.s, splat(0.0), from, 4);
}

// Rows 0 to 3 of the first three columns, rows 4 to 6 of all: the lower triangle and more.
UNISIM_ALWAYS_INLINE void add_symmetric(Block* const blocks[kPackLanes], const PackSymmetric& S) {
  const Targets to(blocks);
  const Pack zero = splat(0.0);
  const Pack3* tt = S.tt.row;
  const Pack3* tr = S.tr.row;
  const Pack3* rr = S.rr.row;
  scatter_add_four(tt[0].x, tt[1].x, tt[2].x, tr[0].x, to.v, 0);
  scatter_add_four(tt[1].x, tt[1].y, tt[2].y, tr[1].x, to.v, 8);
  scatter_add_four(tt[2].x, tt[2].y, tt[2].z, tr[2].x, to.v, 16);
  scatter_add_four(tr[0].x, tr[1].x, tr[2].x, rr[0].x, to.v, 24);
  scatter_add_four(tr[0].y, tr[0].z, S.ts.x, zero, to.v, 4);
  scatter_add_four(tr[1].y, tr[1].z, S.ts.y, zero, to.v, 12);
  scatter_add_four(tr[2].y, tr[2].z, S.ts.z, zero, to.v, 20);
  scatter_add_four(rr[1].x, rr[2].x, S.rs.x, zero, to.v, 28);
  scatter_add_four(rr[1].y, rr[2].y, S.rs.y, zero, to.v, 36);
  scatter_add_four(rr[2].y, rr[2].z, S.rs.z, zero, to.v, 44);
  scatter_add_four(S.rs.y, S.rs.z, S.ss, zero, to.v, 52);
}

// Columns t and r of [[tt, tr, ts], [rt, rr, rs], [st', sr', ss]], three each, then the last.
UNISIM_ALWAYS_INLINE void subtract_columns(double* const from[kPackLanes], int first,
                                           const Pack33& top, const Pack33& middle,
                                           const Pack3& last) {
  const Pack zero = splat(0.0);
  const int at = first * kBlockRows;
  const Pack3* t = top.row;
  const Pack3* m = middle.row;
  scatter_subtract_four(t[0].x, t[1].x, t[2].x, m[0].x, from, at);
  scatter_subtract_four(m[1].x, m[2].x, last.x, zero, from, at + 4);
  scatter_subtract_four(t[0].y, t[1].y, t[2].y, m[0].y, from, at + 8);
  scatter_subtract_four(m[1].y, m[2].y, last.y, zero, from, at + 12);
  scatter_subtract_four(t[0].z, t[1].z, t[2].z, m[0].z, from, at + 16);
  scatter_subtract_four(m[1].z, m[2].z, last.z, zero, from, at + 20);
}

UNISIM_ALWAYS_INLINE void subtract_block(Block* const blocks[kPackLanes], const PackBlocks& U) {
  const Targets from(blocks);
  subtract_columns(from.v, 0, U.tt, U.rt, U.st);
  subtract_columns(from.v, 3, U.tr, U.rr, U.sr);
  scatter_subtract_four(U.ts.x, U.ts.y, U.ts.z, U.rs.x, from.v, 48);
  scatter_subtract_four(U.rs.y, U.rs.z, U.ss, splat(0.0), from.v, 52);
}

UNISIM_ALWAYS_INLINE PackBlocks transposed(const PackBlocks& U) {
  return {transposed(U.tt),
          transposed(U.rt),
          transposed(U.tr),
          transposed(U.rr),
          U.st,
          U.sr,
          U.ts,
          U.rs,
          U.ss};
}

template <QuadShape kShape>
UNISIM_ALWAYS_INLINE void normal_of(const PoseQuad& quad, int first, PackNormal* out) {
  const PackSim3 A = gather_sim3(quad.A + first);
  const PackSim3 B = gather_sim3(quad.B + first);
  const PackSim3 P = gather_sim3(quad.P + first);
  const PackKernel kernel = {load(quad.weight + first), load(quad.delta + first),
                             load(quad.geman_mcclure + first)};
  if constexpr (kShape == QuadShape::kOneMeasurement) {
    relative_pose_normal(A, B, P, nullptr, kernel, out);
  } else if constexpr (kShape == QuadShape::kTwoMeasurements) {
    const PackSim3 Q = gather_sim3(quad.Q + first);
    relative_pose_normal(A, B, P, &Q, kernel, out);
  } else if constexpr (kShape == QuadShape::kChain) {
    chain_normal(A, B, P, gather_symmetric(quad.Lambda + first), kernel, out);
  } else {
    rigid_normal(A, B, P, gather_symmetric(quad.Lambda + first), kernel, out);
  }
}

// Four edges in one pack or two. The blocks of a come first, then those of b: two edges may share
// them, and the order of a sum decides its last digits.
template <QuadShape kShape, bool kGradientOnly>
void add(const PoseQuad& quad) {
  constexpr int kPacks = PoseQuad::kEdges / kPackLanes;
  PackNormal normal[kPacks];
  for (int i = 0; i < kPacks; ++i) {
    const int first = i * kPackLanes;
    normal_of<kShape>(quad, first, &normal[i]);
    for (int lane = 0; lane < kPackLanes; ++lane) {
      *quad.cost[first + lane] = normal[i].cost[lane];
    }
  }
  for (int i = 0; i < kPacks; ++i) {
    if constexpr (!kGradientOnly) add_symmetric(quad.H_aa + i * kPackLanes, normal[i].H_aa);
    subtract_vector(quad.g_a + i * kPackLanes, normal[i].minus_g_a);
  }
  for (int i = 0; i < kPacks; ++i) {
    add_vector(quad.g_b + i * kPackLanes, normal[i].g_b);
    if constexpr (kGradientOnly) continue;
    add_symmetric(quad.H_bb + i * kPackLanes, normal[i].H_bb);
    const PackBlocks& U = normal[i].minus_H_ba;
    subtract_block(quad.H_ab + i * kPackLanes, quad.a_is_later ? transposed(U) : U);
  }
}

template <QuadShape kShape>
void add_as(const PoseQuad& quad) {
  quad.gradient_only ? add<kShape, true>(quad) : add<kShape, false>(quad);
}

}  // namespace

void add_pose_quad(const PoseQuad& quad) {
  switch (quad.shape) {
    case QuadShape::kOneMeasurement:
      return add_as<QuadShape::kOneMeasurement>(quad);
    case QuadShape::kTwoMeasurements:
      return add_as<QuadShape::kTwoMeasurements>(quad);
    case QuadShape::kChain:
      return add_as<QuadShape::kChain>(quad);
    case QuadShape::kRigid:
      return add_as<QuadShape::kRigid>(quad);
  }
}

}  // namespace UNISIM_ISA
}  // namespace unisim
