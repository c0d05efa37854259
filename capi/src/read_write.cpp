// SPDX-License-Identifier: MIT
// Plain C values to core values and back.
#include "capi/src/read_write.hpp"

#include <cmath>

namespace unisim {

bool read_pose(const unisim_sim3& from, Sim3* to) {
  constexpr double kQuaternionTolerance = 1e-3;
  constexpr double kScaleTolerance = 1e-9;
  for (const double value : from.q) {
    if (!std::isfinite(value)) return false;
  }
  for (const double value : from.t) {
    if (!std::isfinite(value)) return false;
  }
  const Quat q(from.q[3], from.q[0], from.q[1], from.q[2]);
  if (!(std::abs(q.norm() - 1.0) <= kQuaternionTolerance)) return false;
  if (!(std::abs(from.s - 1.0) <= kScaleTolerance)) return false;
  to->q = q.normalized();
  to->t = Vec3(from.t[0], from.t[1], from.t[2]);
  to->s = 1.0;
  return true;
}

unisim_sim3 write_pose(const Sim3& from) {
  unisim_sim3 to = {};
  for (int k = 0; k < 4; ++k) to.q[k] = from.q.coeffs()[k];
  for (int k = 0; k < 3; ++k) to.t[k] = from.t[k];
  to.s = from.s;
  return to;
}

bool read_depth(const unisim_depth_map& from, DepthMap* to) {
  constexpr int32_t kLargestSide = 65536;
  if (from.depth == nullptr || from.width <= 0 || from.height <= 0) return false;
  if (from.width > kLargestSide || from.height > kLargestSide) return false;
  *to = {from.depth, from.confidence, from.width, from.height};
  return true;
}

bool is_sigma(double center_sigma) { return std::isfinite(center_sigma) && center_sigma >= 0.0; }

}  // namespace unisim
