// SPDX-License-Identifier: MIT
// As many doubles as a register holds, for vectorised sources: each lane is a problem of its own.
#pragma once

#include <cstdint>

#include "core/base/isa.hpp"

namespace unisim {
namespace UNISIM_ISA {

// Results do not depend on the number of lanes: a lane sees the same operations in the same order.
#if defined(__AVX__)
inline constexpr int kPackLanes = 4;
#else
inline constexpr int kPackLanes = 2;
#endif

using Pack = double __attribute__((vector_size(kPackLanes * sizeof(double))));
/// All bits of a lane set or none; what comparing packs gives.
using PackMask = int64_t __attribute__((vector_size(kPackLanes * sizeof(int64_t))));

UNISIM_ALWAYS_INLINE Pack splat(double value) { return value - Pack{}; }

/// `yes` where the mask is set, else `no`.
UNISIM_ALWAYS_INLINE Pack select(PackMask mask, Pack yes, Pack no) {
  return reinterpret_cast<Pack>((mask & reinterpret_cast<PackMask>(yes)) |
                                (~mask & reinterpret_cast<PackMask>(no)));
}

UNISIM_ALWAYS_INLINE bool all(PackMask mask) {
  bool out = true;
  for (int lane = 0; lane < kPackLanes; ++lane) out = out && mask[lane] != 0;
  return out;
}

UNISIM_ALWAYS_INLINE Pack square_root(Pack x) {
  for (int lane = 0; lane < kPackLanes; ++lane) x[lane] = __builtin_sqrt(x[lane]);
  return x;
}

// ---- between packs and arrays; the number of lanes shows here only
#if defined(__clang__)
#define UNISIM_SHUFFLE(a, b, ...) __builtin_shufflevector(a, b, __VA_ARGS__)
#else
#define UNISIM_SHUFFLE(a, b, ...) __builtin_shuffle(a, b, PackMask{__VA_ARGS__})
#endif

#if defined(__AVX__)

UNISIM_ALWAYS_INLINE Pack load(const double v[kPackLanes]) { return Pack{v[0], v[1], v[2], v[3]}; }

/// Element `index` of an array per lane.
UNISIM_ALWAYS_INLINE Pack gather(const double* const from[kPackLanes], int index) {
  return Pack{from[0][index], from[1][index], from[2][index], from[3][index]};
}

/// Lane i of pack j becomes lane j of pack i.
UNISIM_ALWAYS_INLINE void transpose(Pack p[4]) {
  const Pack even_01 = UNISIM_SHUFFLE(p[0], p[1], 0, 4, 2, 6);
  const Pack odd_01 = UNISIM_SHUFFLE(p[0], p[1], 1, 5, 3, 7);
  const Pack even_23 = UNISIM_SHUFFLE(p[2], p[3], 0, 4, 2, 6);
  const Pack odd_23 = UNISIM_SHUFFLE(p[2], p[3], 1, 5, 3, 7);
  p[0] = UNISIM_SHUFFLE(even_01, even_23, 0, 1, 4, 5);
  p[1] = UNISIM_SHUFFLE(odd_01, odd_23, 0, 1, 4, 5);
  p[2] = UNISIM_SHUFFLE(even_01, even_23, 2, 3, 6, 7);
  p[3] = UNISIM_SHUFFLE(odd_01, odd_23, 2, 3, 6, 7);
}

/// Elements first .. first + 3 of an array per lane.
UNISIM_ALWAYS_INLINE void gather_four(const double* const from[kPackLanes], int first,
                                      Pack out[4]) {
  for (int lane = 0; lane < kPackLanes; ++lane) out[lane] = load(from[lane] + first);
  transpose(out);
}

/// Adds four packs to elements first .. first + 3 of an array per lane, aligned to 32 bytes.
UNISIM_ALWAYS_INLINE void scatter_add_four(Pack p0, Pack p1, Pack p2, Pack p3,
                                           double* const to[kPackLanes], int first) {
  Pack p[4] = {p0, p1, p2, p3};
  transpose(p);
  for (int lane = 0; lane < kPackLanes; ++lane) {
    *reinterpret_cast<Pack*>(to[lane] + first) += p[lane];
  }
}

/// Subtracts them.
UNISIM_ALWAYS_INLINE void scatter_subtract_four(Pack p0, Pack p1, Pack p2, Pack p3,
                                                double* const from[kPackLanes], int first) {
  Pack p[4] = {p0, p1, p2, p3};
  transpose(p);
  for (int lane = 0; lane < kPackLanes; ++lane) {
    *reinterpret_cast<Pack*>(from[lane] + first) -= p[lane];
  }
}

#else

UNISIM_ALWAYS_INLINE Pack load(const double v[kPackLanes]) { return Pack{v[0], v[1]}; }

UNISIM_ALWAYS_INLINE Pack gather(const double* const from[kPackLanes], int index) {
  return Pack{from[0][index], from[1][index]};
}

UNISIM_ALWAYS_INLINE void gather_four(const double* const from[kPackLanes], int first,
                                      Pack out[4]) {
  for (int i = 0; i < 4; ++i) out[i] = gather(from, first + i);
}

UNISIM_ALWAYS_INLINE void scatter_add_four(Pack p0, Pack p1, Pack p2, Pack p3,
                                           double* const to[kPackLanes], int first) {
  Pack* lane_0 = reinterpret_cast<Pack*>(to[0] + first);
  lane_0[0] += UNISIM_SHUFFLE(p0, p1, 0, 2);
  lane_0[1] += UNISIM_SHUFFLE(p2, p3, 0, 2);
  Pack* lane_1 = reinterpret_cast<Pack*>(to[1] + first);
  lane_1[0] += UNISIM_SHUFFLE(p0, p1, 1, 3);
  lane_1[1] += UNISIM_SHUFFLE(p2, p3, 1, 3);
}

UNISIM_ALWAYS_INLINE void scatter_subtract_four(Pack p0, Pack p1, Pack p2, Pack p3,
                                                double* const from[kPackLanes], int first) {
  Pack* lane_0 = reinterpret_cast<Pack*>(from[0] + first);
  lane_0[0] -= UNISIM_SHUFFLE(p0, p1, 0, 2);
  lane_0[1] -= UNISIM_SHUFFLE(p2, p3, 0, 2);
  Pack* lane_1 = reinterpret_cast<Pack*>(from[1] + first);
  lane_1[0] -= UNISIM_SHUFFLE(p0, p1, 1, 3);
  lane_1[1] -= UNISIM_SHUFFLE(p2, p3, 1, 3);
}

#endif

#undef UNISIM_SHUFFLE

}  // namespace UNISIM_ISA
}  // namespace unisim
