// SPDX-License-Identifier: MIT
// Four pose edges at once into the normal equations; vectorised.
#include "core/solve/linearize/pose_quad.hpp"

#include "core/graph/relative_pose_pack.hpp"
#include "core/graph/rigid_pack.hpp"

namespace unisim {
namespace UNISIM_ISA {
namespace {

static_assert(PoseQuad::kEdges % kPackLanes == 0, "a lane per edge");

struct PackRobustCost {
  Pack cost;
  Pack weight;
};

// robust_kernel.hpp, all kernels at once.
UNISIM_ALWAYS_INLINE PackRobustCost robust_cost(Pack delta, Pack geman_mcclure, Pack u_squared) {
  const PackMask is_geman_mcclure = splat(0.0) < geman_mcclure;
  const Pack delta2 = delta * delta;
  const Pack half = 0.5 * u_squared;
  const Pack u = square_root(u_squared);
  const PackMask inside = u_squared <= delta2;
  const Pack g = 1.0 / (1.0 + u_squared / delta2);
  const Pack huber_cost = select(inside, half, delta * (u - 0.5 * delta));
  const Pack huber_weight = select(inside, splat(1.0), delta / u);
  return {select(is_geman_mcclure, half * g, huber_cost),
          select(is_geman_mcclure, g * g, huber_weight)};
}

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

// Four rows of one column to each edge's block.
UNISIM_ALWAYS_INLINE void add_rows(double* const to[kPackLanes], int offset, Pack w, Pack r0,
                                   Pack r1, Pack r2, Pack r3) {
  scatter_add_four(w * r0, w * r1, w * r2, w * r3, to, offset);
}

UNISIM_ALWAYS_INLINE void add_vector(double* const to[kPackLanes], Pack w, const PackVector& g) {
  add_rows(to, 0, w, g.t.x, g.t.y, g.t.z, g.r.x);
  add_rows(to, 4, w, g.r.y, g.r.z, g.s, splat(0.0));
}

// Rows 0 to 3 of the first three columns, rows 4 to 6 of all: the lower triangle and more.
UNISIM_ALWAYS_INLINE void add_symmetric(Block* const blocks[kPackLanes], Pack w,
                                        const PackSymmetric& S) {
  const Targets to(blocks);
  const Pack zero = splat(0.0);
  add_rows(to.v, 0, w, S.tt.row[0].x, S.tt.row[1].x, S.tt.row[2].x, S.tr.row[0].x);
  add_rows(to.v, 8, w, S.tt.row[0].y, S.tt.row[1].y, S.tt.row[2].y, S.tr.row[1].x);
  add_rows(to.v, 16, w, S.tt.row[0].z, S.tt.row[1].z, S.tt.row[2].z, S.tr.row[2].x);
  add_rows(to.v, 24, w, S.tr.row[0].x, S.tr.row[1].x, S.tr.row[2].x, S.rr.row[0].x);
  add_rows(to.v, 4, w, S.tr.row[0].y, S.tr.row[0].z, S.ts.x, zero);
  add_rows(to.v, 12, w, S.tr.row[1].y, S.tr.row[1].z, S.ts.y, zero);
  add_rows(to.v, 20, w, S.tr.row[2].y, S.tr.row[2].z, S.ts.z, zero);
  add_rows(to.v, 28, w, S.rr.row[1].x, S.rr.row[2].x, S.rs.x, zero);
  add_rows(to.v, 36, w, S.rr.row[1].y, S.rr.row[2].y, S.rs.y, zero);
  add_rows(to.v, 44, w, S.rr.row[1].z, S.rr.row[2].z, S.rs.z, zero);
  add_rows(to.v, 52, w, S.rs.y, S.rs.z, S.ss, zero);
}

// Columns t and r of [[tt, tr, ts], [rt, rr, rs], [st', sr', ss]], three each, then the last.
UNISIM_ALWAYS_INLINE void add_columns(double* const to[kPackLanes], int first, Pack w,
                                      const Pack33& top, const Pack33& middle, const Pack3& last) {
  const Pack zero = splat(0.0);
  const int at = first * kBlockRows;
  add_rows(to, at, w, top.row[0].x, top.row[1].x, top.row[2].x, middle.row[0].x);
  add_rows(to, at + 4, w, middle.row[1].x, middle.row[2].x, last.x, zero);
  add_rows(to, at + 8, w, top.row[0].y, top.row[1].y, top.row[2].y, middle.row[0].y);
  add_rows(to, at + 12, w, middle.row[1].y, middle.row[2].y, last.y, zero);
  add_rows(to, at + 16, w, top.row[0].z, top.row[1].z, top.row[2].z, middle.row[0].z);
  add_rows(to, at + 20, w, middle.row[1].z, middle.row[2].z, last.z, zero);
}

UNISIM_ALWAYS_INLINE void add_block(Block* const blocks[kPackLanes], Pack w, const PackBlocks& U) {
  const Targets to(blocks);
  add_columns(to.v, 0, w, U.tt, U.rt, U.st);
  add_columns(to.v, 3, w, U.tr, U.rr, U.sr);
  add_rows(to.v, 48, w, U.ts.x, U.ts.y, U.ts.z, U.rs.x);
  add_rows(to.v, 52, w, U.rs.y, U.rs.z, U.ss, splat(0.0));
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
  if constexpr (kShape == QuadShape::kOneMeasurement) {
    relative_pose_normal(A, B, P, nullptr, out);
  } else if constexpr (kShape == QuadShape::kTwoMeasurements) {
    const PackSim3 Q = gather_sim3(quad.Q + first);
    relative_pose_normal(A, B, P, &Q, out);
  } else if constexpr (kShape == QuadShape::kChain) {
    chain_normal(A, B, P, gather_symmetric(quad.Lambda + first), out);
  } else {
    rigid_normal(A, B, P, gather_symmetric(quad.Lambda + first), out);
  }
}

// Four edges in one pack or two. The blocks of a come first, then those of b: two edges may share
// them, and the order of a sum decides its last digits.
template <QuadShape kShape, bool kGradientOnly>
void add(const PoseQuad& quad) {
  constexpr int kPacks = PoseQuad::kEdges / kPackLanes;
  PackNormal normal[kPacks];
  Pack w[kPacks];
  for (int i = 0; i < kPacks; ++i) {
    const int first = i * kPackLanes;
    normal_of<kShape>(quad, first, &normal[i]);
    const Pack weight = load(quad.weight + first);
    const PackRobustCost robust = robust_cost(
        load(quad.delta + first), load(quad.geman_mcclure + first), weight * normal[i].u_squared);
    w[i] = weight * robust.weight;
    for (int lane = 0; lane < kPackLanes; ++lane) *quad.cost[first + lane] = robust.cost[lane];
  }
  for (int i = 0; i < kPacks; ++i) {
    if constexpr (!kGradientOnly) add_symmetric(quad.H_aa + i * kPackLanes, w[i], normal[i].H_aa);
    add_vector(quad.g_a + i * kPackLanes, -w[i], normal[i].minus_g_a);
  }
  for (int i = 0; i < kPacks; ++i) {
    add_vector(quad.g_b + i * kPackLanes, w[i], normal[i].g_b);
    if constexpr (kGradientOnly) continue;
    add_symmetric(quad.H_bb + i * kPackLanes, w[i], normal[i].H_bb);
    const PackBlocks& U = normal[i].minus_H_ba;
    add_block(quad.H_ab + i * kPackLanes, -w[i], quad.a_is_later ? transposed(U) : U);
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
