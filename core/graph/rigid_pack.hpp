// SPDX-License-Identifier: MIT
// Normal equations of a rigid factor per lane, for vectorised sources.
#pragma once

#include "core/graph/relative_pose_pack.hpp"

namespace unisim {
namespace UNISIM_ISA {

/// rigid.hpp. Nothing depends on the log-scales: their rows and columns are zero but for a one on
/// each diagonal (times the weight), which keeps the blocks positive.
UNISIM_ALWAYS_INLINE void rigid_normal(const PackSim3& A, const PackSim3& B, const PackSim3& Z,
                                       const PackSymmetric& Lambda, const PackKernel& kernel,
                                       PackNormal* out) {
  const PackSim3 D = between(A, B);
  const PackSim3 E = between(Z, D);
  const Pack sign = select(E.q.w < splat(0.0), splat(-1.0), splat(1.0));
  const Pack3 v = sign * vector_part(E.q);
  const Pack zero = splat(0.0);
  const Pack33 zeros = {{{zero, zero, zero}, {zero, zero, zero}, {zero, zero, zero}}};
  const Pack33 R = rotation_matrix(E.q);
  const Pack33 J = splat(0.5) * plus_hat(plus_diagonal(zeros, sign * E.q.w), v);
  const Pack33 L_tr = times(Lambda.tr, J);
  const Pack33 L_rr = times(Lambda.rr, J);
  PackSymmetric& S = out->H_bb;
  S.tt = transposed_times(R, times(Lambda.tt, R));
  S.tr = transposed_times(R, L_tr);
  S.rr = transposed_times(J, L_rr);
  S.ts = S.rs = {zero, zero, zero};
  S.ss = splat(1.0);
  const Pack3 l_t = times(Lambda.tt, E.t) + times(Lambda.tr, v);  // Lambda e
  const Pack3 l_r = times(E.t, Lambda.tr) + times(Lambda.rr, v);
  out->g_b = {times(l_t, R), times(l_r, J), zero};
  weigh(kernel, dot(E.t, l_t) + dot(v, l_r), out);
  add_other_node(inverse(D), out);
  out->minus_g_a.s = zero;
  out->H_aa.ts = out->H_aa.rs = {zero, zero, zero};
  out->minus_H_ba.ts = out->minus_H_ba.rs = {zero, zero, zero};
  out->minus_H_ba.st = out->minus_H_ba.sr = {zero, zero, zero};
  out->minus_H_ba.ss = zero;
  out->H_aa.ss = out->H_bb.ss;
}

}  // namespace UNISIM_ISA
}  // namespace unisim
