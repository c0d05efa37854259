// SPDX-License-Identifier: MIT
// Normal equations of a pose edge e = log((A P)^-1 (B Q)) per lane, for vectorised sources.
//
// With D = A^-1 B, J_e_A = -J_e_B Ad(D^-1): one sandwich of H_bb with Ad(D^-1) gives the other two
// blocks. Ad(T) = [[s I, hat(t), -t], [0, I, 0], [0, 0, 1]] diag(R, R, 1): the left factor costs
// little, so the rotation comes last.
#pragma once

#include "core/graph/robust_kernel_pack.hpp"
#include "core/lie/sim3_log_pack.hpp"

namespace unisim {
namespace UNISIM_ISA {

/// Symmetric 7x7 by blocks of the tangent: [[tt, tr, ts], [tr', rr, rs], [ts', rs', ss]].
struct PackSymmetric {
  Pack33 tt, tr, rr;
  Pack3 ts, rs;
  Pack ss;
};

/// 7x7 by blocks, rows first: [[tt, tr, ts], [rt, rr, rs], [st', sr', ss]].
struct PackBlocks {
  Pack33 tt, tr, rt, rr;
  Pack3 ts, rs, st, sr;
  Pack ss;
};

struct PackVector {
  Pack3 t, r;
  Pack s;
};

/// rho(u) and the quadratic form w e' Lambda e of right perturbations of a and b that stands in for
/// it. Of H_aa and H_bb only the lower triangles count.
struct PackNormal {
  Pack cost;
  PackSymmetric H_aa, H_bb;
  PackBlocks minus_H_ba;
  PackVector g_b, minus_g_a;
};

/// Puts the kernel on the form of b, whose square is known.
UNISIM_ALWAYS_INLINE void weigh(const PackKernel& kernel, Pack square, PackNormal* out) {
  const PackRobustCost robust = robust_cost(kernel, kernel.weight * square);
  const Pack w = kernel.weight * robust.weight;
  out->cost = robust.cost;
  PackSymmetric& S = out->H_bb;
  S = {w * S.tt, w * S.tr, w * S.rr, w * S.ts, w * S.rs, w * S.ss};
  out->g_b = {w * out->g_b.t, w * out->g_b.r, w * out->g_b.s};
}

/// M' M and M' e.
UNISIM_ALWAYS_INLINE void square(const PackJacobianInverse& M, const PackTangent& e,
                                 const PackKernel& kernel, PackNormal* out) {
  PackSymmetric& S = out->H_bb;
  S.tt = M.V_square;
  S.tr = transposed_times(M.V_inv, M.X);
  S.rr = square(M.X) + M.J_square;
  S.ts = times(M.x, M.V_inv);
  S.rs = times(M.x, M.X);
  S.ss = dot(M.x, M.x) + 1.0;
  out->g_b.t = times(e.rho, M.V_inv);
  out->g_b.r = times(e.rho, M.X) + times(e.phi, M.J_inv);
  out->g_b.s = dot(M.x, e.rho) + e.sigma;
  weigh(kernel, dot(e.rho, e.rho) + dot(e.phi, e.phi) + e.sigma * e.sigma, out);
}

/// M' Lambda M and M' Lambda e.
UNISIM_ALWAYS_INLINE void weighted_square(const PackJacobianInverse& M, const PackTangent& e,
                                          const PackSymmetric& L, const PackKernel& kernel,
                                          PackNormal* out) {
  const Pack33 rt = transposed(L.tr);
  const Pack33 L_tr = times(L.tt, M.X) + times(L.tr, M.J_inv);  // Lambda M by blocks
  const Pack33 L_rr = times(rt, M.X) + times(L.rr, M.J_inv);
  const Pack3 L_ts = times(L.tt, M.x) + L.ts;
  const Pack3 L_rs = times(rt, M.x) + L.rs;
  PackSymmetric& S = out->H_bb;
  S.tt = transposed_times(M.V_inv, times(L.tt, M.V_inv));
  S.tr = transposed_times(M.V_inv, L_tr);
  S.rr = transposed_times(M.X, L_tr) + transposed_times(M.J_inv, L_rr);
  S.ts = times(L_ts, M.V_inv);
  S.rs = times(L_ts, M.X) + times(L_rs, M.J_inv);
  S.ss = dot(M.x, L_ts) + dot(L.ts, M.x) + L.ss;
  const Pack3 l_t = times(L.tt, e.rho) + times(L.tr, e.phi) + e.sigma * L.ts;  // Lambda e
  const Pack3 l_r = times(rt, e.rho) + times(L.rr, e.phi) + e.sigma * L.rs;
  const Pack l_s = dot(L.ts, e.rho) + dot(L.rs, e.phi) + e.sigma * L.ss;
  out->g_b.t = times(l_t, M.V_inv);
  out->g_b.r = times(l_t, M.X) + times(l_r, M.J_inv);
  out->g_b.s = dot(M.x, l_t) + l_s;
  weigh(kernel, dot(e.rho, l_t) + dot(e.phi, l_r) + e.sigma * l_s, out);
}

/// S Ad(T) and Ad(T)' S Ad(T).
UNISIM_ALWAYS_INLINE void sandwich(const PackSymmetric& S, const PackSim3& T, PackBlocks* half,
                                   PackSymmetric* whole) {
  const Pack33 R = rotation_matrix(T.q);
  const Pack33 sR = T.s * R;
  const Pack33 rt = transposed(S.tr);
  const Pack33 tr = times_hat(S.tt, T.t) + S.tr;  // before the rotation
  const Pack33 rr = times_hat(rt, T.t) + S.rr;
  half->tt = times(S.tt, sR);
  half->tr = times(tr, R);
  half->ts = S.ts - times(S.tt, T.t);
  half->rt = times(rt, sR);
  half->rr = times(rr, R);
  half->rs = S.rs - times(rt, T.t);
  half->st = times(S.ts, sR);
  half->sr = times(cross(S.ts, T.t) + S.rs, R);
  half->ss = S.ss - dot(S.ts, T.t);

  whole->tt = transposed_times(sR, half->tt);
  whole->tr = transposed_times(sR, half->tr);
  whole->rr = transposed_times(R, times(hat_transposed_times(T.t, tr) + rr, R));
  whole->ts = times(half->ts, sR);
  whole->rs = times(cross(half->ts, T.t) + half->rs, R);
  whole->ss = half->ss - dot(half->ts, T.t);
}

/// Ad(T)' g.
UNISIM_ALWAYS_INLINE PackVector adjoint_transposed_times(const PackSim3& T, const PackVector& g) {
  const Pack33 R = rotation_matrix(T.q);
  return {T.s * times(g.t, R), times(cross(g.t, T.t) + g.r, R), g.s - dot(g.t, T.t)};
}

/// The blocks of a from those of b; T = (A^-1 B)^-1.
UNISIM_ALWAYS_INLINE void add_other_node(const PackSim3& T, PackNormal* out) {
  sandwich(out->H_bb, T, &out->minus_H_ba, &out->H_aa);
  out->minus_g_a = adjoint_transposed_times(T, out->g_b);
}

/// A pose factor whose information is the identity.
/// @param Q nullptr: identity, which saves a sandwich
UNISIM_ALWAYS_INLINE void relative_pose_normal(const PackSim3& A, const PackSim3& B,
                                               const PackSim3& P, const PackSim3* Q,
                                               const PackKernel& kernel, PackNormal* out) {
  const PackSim3 D = between(A, B);
  PackTangent e;
  PackJacobianInverse M;
  log_with_jacobian(between(P, Q == nullptr ? D : times(D, *Q)), &e, &M);
  square(M, e, kernel, out);
  if (Q != nullptr) {
    const PackSim3 Q_inverse = inverse(*Q);
    const PackSymmetric inner = out->H_bb;
    PackBlocks unused;
    sandwich(inner, Q_inverse, &unused, &out->H_bb);
    out->g_b = adjoint_transposed_times(Q_inverse, out->g_b);
  }
  add_other_node(inverse(D), out);
}

/// A chain factor: full information.
UNISIM_ALWAYS_INLINE void chain_normal(const PackSim3& A, const PackSim3& B, const PackSim3& Z,
                                       const PackSymmetric& Lambda, const PackKernel& kernel,
                                       PackNormal* out) {
  const PackSim3 D = between(A, B);
  PackTangent e;
  PackJacobianInverse M;
  log_with_jacobian(between(Z, D), &e, &M);
  weighted_square(M, e, Lambda, kernel, out);
  add_other_node(inverse(D), out);
}

}  // namespace UNISIM_ISA
}  // namespace unisim
