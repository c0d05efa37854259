// SPDX-License-Identifier: MIT
// Residual shared by the pose factors.
#include "core/graph/relative_pose.hpp"

#include "core/lie/so3.hpp"

namespace unisim {
namespace {

// Blocks of Ad(T) that are not constant: [[sR, tR, -t], [0, R, 0], [0, 0, 1]].
struct AdjointBlocks {
  explicit AdjointBlocks(const Sim3& T)
      : R(T.q.toRotationMatrix()), sR(T.s * R), tR(hat(T.t) * R), t(T.t) {}
  Mat3 R;
  Mat3 sR;
  Mat3 tR;
  Vec3 t;
};

// S Ad, 7x7 in blocks by rows.
struct HalfSandwich {
  Mat3 tt, tr, rt, rr;
  Vec3 ts, rs, st, sr;
  double ss;
};

HalfSandwich times_adjoint(const SymmetricBlocks& S, const AdjointBlocks& Ad) {
  HalfSandwich U;
  U.tt = S.tt * Ad.sR;
  U.tr = S.tt * Ad.tR + S.tr * Ad.R;
  U.ts = S.ts - S.tt * Ad.t;
  U.rt = S.tr.transpose() * Ad.sR;
  U.rr = S.tr.transpose() * Ad.tR + S.rr * Ad.R;
  U.rs = S.rs - S.tr.transpose() * Ad.t;
  U.st = Ad.sR.transpose() * S.ts;
  U.sr = Ad.tR.transpose() * S.ts + Ad.R.transpose() * S.rs;
  U.ss = S.ss - S.ts.dot(Ad.t);
  return U;
}

// Ad' U for U = S Ad.
SymmetricBlocks adjoint_times(const AdjointBlocks& Ad, const HalfSandwich& U) {
  SymmetricBlocks out;
  out.tt = Ad.sR.transpose() * U.tt;
  out.tr = Ad.sR.transpose() * U.tr;
  out.ts = Ad.sR.transpose() * U.ts;
  out.rr = Ad.tR.transpose() * U.tr + Ad.R.transpose() * U.rr;
  out.rs = Ad.tR.transpose() * U.ts + Ad.R.transpose() * U.rs;
  out.ss = U.ss - Ad.t.dot(U.ts);
  return out;
}

// Ad' g.
Vec7 adjoint_transposed_times(const AdjointBlocks& Ad, const Vec7& g) {
  Vec7 out;
  out.head<3>() = Ad.sR.transpose() * g.head<3>();
  out.segment<3>(3) = Ad.tR.transpose() * g.head<3>() + Ad.R.transpose() * g.segment<3>(3);
  out(6) = g(6) - Ad.t.dot(g.head<3>());
  return out;
}

// M' M and M' e for M = J_r^-1(e).
void square(const Sim3JacobianInverse& M, const Vec7& e, SymmetricBlocks* S, Vec7* g) {
  S->tt = M.V_inv.transpose() * M.V_inv;
  S->tr = M.V_inv.transpose() * M.X;
  S->rr = M.X.transpose() * M.X + M.J_inv.transpose() * M.J_inv;
  S->ts = M.V_inv.transpose() * M.x;
  S->rs = M.X.transpose() * M.x;
  S->ss = M.x.squaredNorm() + 1.0;
  g->head<3>() = M.V_inv.transpose() * e.head<3>();
  g->segment<3>(3) = M.X.transpose() * e.head<3>() + M.J_inv.transpose() * e.segment<3>(3);
  (*g)(6) = M.x.dot(e.head<3>()) + e(6);
}

}  // namespace

Vec7 relative_pose_residual(const Sim3& A, const Sim3& B, const Sim3& P, const Sim3& Q) {
  return sim3_log(between(P, between(A, B) * Q));
}

RelativePoseJacobians relative_pose_jacobians(const Sim3& A, const Sim3& B, const Sim3& P,
                                              const Sim3& Q) {
  RelativePoseJacobians out;
  out.e = relative_pose_residual(A, B, P, Q);
  out.J_e_A = -sim3_left_jacobian_inverse(out.e) * sim3_adjoint(P.inverse());
  out.J_e_B = sim3_right_jacobian_inverse(out.e) * sim3_adjoint(Q.inverse());
  return out;
}

void relative_pose_normal(const Sim3& A, const Sim3& B, const Sim3& P, const Sim3* Q,
                          RelativePoseNormal* out) {
  const Sim3 D = between(A, B);
  Sim3JacobianInverse M;
  sim3_log_with_jacobian(between(P, Q == nullptr ? D : D * *Q), &out->e, &M);
  square(M, out->e, &out->H_bb, &out->g_b);
  if (Q != nullptr) {
    const AdjointBlocks Ad(Q->inverse());
    out->H_bb = adjoint_times(Ad, times_adjoint(out->H_bb, Ad));
    out->g_b = adjoint_transposed_times(Ad, out->g_b);
  }
  const AdjointBlocks Ad(D.inverse());
  const HalfSandwich U = times_adjoint(out->H_bb, Ad);
  out->H_aa = adjoint_times(Ad, U);
  out->g_a = -adjoint_transposed_times(Ad, out->g_b);
  out->H_ba.topLeftCorner<3, 3>() = -U.tt;
  out->H_ba.block<3, 3>(0, 3) = -U.tr;
  out->H_ba.block<3, 1>(0, 6) = -U.ts;
  out->H_ba.block<3, 3>(3, 0) = -U.rt;
  out->H_ba.block<3, 3>(3, 3) = -U.rr;
  out->H_ba.block<3, 1>(3, 6) = -U.rs;
  out->H_ba.block<1, 3>(6, 0) = -U.st.transpose();
  out->H_ba.block<1, 3>(6, 3) = -U.sr.transpose();
  out->H_ba(6, 6) = -U.ss;
}

}  // namespace unisim
