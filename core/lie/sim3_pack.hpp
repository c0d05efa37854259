// SPDX-License-Identifier: MIT
// A similarity per lane, for vectorised sources: the formulas of so3.hpp and sim3.hpp.
#pragma once

#include "core/base/pack.hpp"

namespace unisim {
namespace UNISIM_ISA {

struct Pack3 {
  Pack x, y, z;
};

/// 3x3 matrix by its rows.
struct Pack33 {
  Pack3 row[3];
};

struct PackQuat {
  Pack x, y, z, w;
};

struct PackSim3 {
  PackQuat q;
  Pack3 t;
  Pack s;
};

// ---- vectors
UNISIM_ALWAYS_INLINE Pack3 operator+(const Pack3& a, const Pack3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
UNISIM_ALWAYS_INLINE Pack3 operator-(const Pack3& a, const Pack3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
UNISIM_ALWAYS_INLINE Pack3 operator*(Pack k, const Pack3& v) { return {k * v.x, k * v.y, k * v.z}; }
UNISIM_ALWAYS_INLINE Pack dot(const Pack3& a, const Pack3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
UNISIM_ALWAYS_INLINE Pack3 cross(const Pack3& a, const Pack3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// ---- matrices
UNISIM_ALWAYS_INLINE Pack33 operator+(const Pack33& A, const Pack33& B) {
  return {{A.row[0] + B.row[0], A.row[1] + B.row[1], A.row[2] + B.row[2]}};
}
UNISIM_ALWAYS_INLINE Pack33 operator-(const Pack33& A, const Pack33& B) {
  return {{A.row[0] - B.row[0], A.row[1] - B.row[1], A.row[2] - B.row[2]}};
}
UNISIM_ALWAYS_INLINE Pack33 operator*(Pack k, const Pack33& A) {
  return {{k * A.row[0], k * A.row[1], k * A.row[2]}};
}
UNISIM_ALWAYS_INLINE Pack33 transposed(const Pack33& A) {
  return {{{A.row[0].x, A.row[1].x, A.row[2].x},
           {A.row[0].y, A.row[1].y, A.row[2].y},
           {A.row[0].z, A.row[1].z, A.row[2].z}}};
}
/// v' A, as a column: A' v.
UNISIM_ALWAYS_INLINE Pack3 times(const Pack3& v, const Pack33& A) {
  return v.x * A.row[0] + v.y * A.row[1] + v.z * A.row[2];
}
/// A v.
UNISIM_ALWAYS_INLINE Pack3 times(const Pack33& A, const Pack3& v) {
  return {dot(A.row[0], v), dot(A.row[1], v), dot(A.row[2], v)};
}
/// A B.
UNISIM_ALWAYS_INLINE Pack33 times(const Pack33& A, const Pack33& B) {
  return {{times(A.row[0], B), times(A.row[1], B), times(A.row[2], B)}};
}
/// A' B.
UNISIM_ALWAYS_INLINE Pack33 transposed_times(const Pack33& A, const Pack33& B) {
  return times(transposed(A), B);
}
/// A hat(t).
UNISIM_ALWAYS_INLINE Pack33 times_hat(const Pack33& A, const Pack3& t) {
  return {{cross(A.row[0], t), cross(A.row[1], t), cross(A.row[2], t)}};
}
/// hat(t)' A.
UNISIM_ALWAYS_INLINE Pack33 hat_transposed_times(const Pack3& t, const Pack33& A) {
  const Pack33 B = transposed(A);
  return transposed(times_hat(B, t));
}
/// A + hat(v).
UNISIM_ALWAYS_INLINE Pack33 plus_hat(Pack33 A, const Pack3& v) {
  A.row[0].y -= v.z;
  A.row[0].z += v.y;
  A.row[1].x += v.z;
  A.row[1].z -= v.x;
  A.row[2].x -= v.y;
  A.row[2].y += v.x;
  return A;
}
/// A + k I.
UNISIM_ALWAYS_INLINE Pack33 plus_diagonal(Pack33 A, Pack k) {
  A.row[0].x += k;
  A.row[1].y += k;
  A.row[2].z += k;
  return A;
}
/// A symmetric matrix from its lower triangle.
UNISIM_ALWAYS_INLINE Pack33 symmetric(Pack xx, Pack yx, Pack yy, Pack zx, Pack zy, Pack zz) {
  return {{{xx, yx, zx}, {yx, yy, zy}, {zx, zy, zz}}};
}
/// a b' where it is symmetric.
UNISIM_ALWAYS_INLINE Pack33 square(const Pack3& a, const Pack3& b) {
  return symmetric(a.x * b.x, a.y * b.x, a.y * b.y, a.z * b.x, a.z * b.y, a.z * b.z);
}
/// A' A.
UNISIM_ALWAYS_INLINE Pack33 square(const Pack33& A) {
  const Pack33 C = transposed(A);
  return symmetric(dot(C.row[0], C.row[0]), dot(C.row[1], C.row[0]), dot(C.row[1], C.row[1]),
                   dot(C.row[2], C.row[0]), dot(C.row[2], C.row[1]), dot(C.row[2], C.row[2]));
}
/// a b'.
UNISIM_ALWAYS_INLINE Pack33 outer(const Pack3& a, const Pack3& b) {
  return {{a.x * b, a.y * b, a.z * b}};
}

// ---- rotations and similarities
UNISIM_ALWAYS_INLINE Pack3 vector_part(const PackQuat& q) { return {q.x, q.y, q.z}; }

/// R v.
UNISIM_ALWAYS_INLINE Pack3 rotate(const PackQuat& q, const Pack3& v) {
  const Pack3 u = vector_part(q);
  const Pack3 once = cross(u, v);
  const Pack3 twice = once + once;
  return v + q.w * twice + cross(u, twice);
}

/// R' v.
UNISIM_ALWAYS_INLINE Pack3 rotate_inverse(const PackQuat& q, const Pack3& v) {
  return rotate({-q.x, -q.y, -q.z, q.w}, v);
}

/// Product, drawn back to length 1 by one Newton step.
UNISIM_ALWAYS_INLINE PackQuat times(const PackQuat& a, const PackQuat& b) {
  const PackQuat q = {
      a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z,
      a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
  const Pack length2 = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  const Pack k = 1.5 - 0.5 * length2;
  return {k * q.x, k * q.y, k * q.z, k * q.w};
}

UNISIM_ALWAYS_INLINE Pack33 rotation_matrix(const PackQuat& q) {
  const Pack3 twice = {q.x + q.x, q.y + q.y, q.z + q.z};
  const Pack xx = twice.x * q.x, xy = twice.x * q.y, xz = twice.x * q.z, xw = twice.x * q.w;
  const Pack yy = twice.y * q.y, yz = twice.y * q.z, yw = twice.y * q.w;
  const Pack zz = twice.z * q.z, zw = twice.z * q.w;
  return {{{1.0 - (yy + zz), xy - zw, xz + yw},
           {xy + zw, 1.0 - (xx + zz), yz - xw},
           {xz - yw, yz + xw, 1.0 - (xx + yy)}}};
}

/// a b.
UNISIM_ALWAYS_INLINE PackSim3 times(const PackSim3& a, const PackSim3& b) {
  return {times(a.q, b.q), a.s * rotate(a.q, b.t) + a.t, a.s * b.s};
}

UNISIM_ALWAYS_INLINE PackSim3 inverse(const PackSim3& a) {
  const Pack inv_s = 1.0 / a.s;
  return {{-a.q.x, -a.q.y, -a.q.z, a.q.w}, -inv_s * rotate_inverse(a.q, a.t), inv_s};
}

/// a^-1 b.
UNISIM_ALWAYS_INLINE PackSim3 between(const PackSim3& a, const PackSim3& b) {
  const Pack inv_s = 1.0 / a.s;
  return {times({-a.q.x, -a.q.y, -a.q.z, a.q.w}, b.q), inv_s * rotate_inverse(a.q, b.t - a.t),
          inv_s * b.s};
}

/// A Sim3 per lane, each eight numbers: x y z w of the quaternion, translation, scale.
UNISIM_ALWAYS_INLINE PackSim3 gather_sim3(const double* const from[kPackLanes]) {
  Pack low[4], high[4];
  gather_four(from, 0, low);
  gather_four(from, 4, high);
  return {{low[0], low[1], low[2], low[3]}, {high[0], high[1], high[2]}, high[3]};
}

}  // namespace UNISIM_ISA
}  // namespace unisim
