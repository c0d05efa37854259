// SPDX-License-Identifier: MIT
// Composition and inverse of similarities given as C structs.
#include "drivers/pipeline/similarity.hpp"

#include <cmath>

namespace unisim::pipeline {

unisim_sim3 compose(const unisim_sim3& T_a_b, const unisim_sim3& T_b_c) {
  const double ax = T_a_b.q[0], ay = T_a_b.q[1], az = T_a_b.q[2], aw = T_a_b.q[3];
  const double bx = T_b_c.q[0], by = T_b_c.q[1], bz = T_b_c.q[2], bw = T_b_c.q[3];
  unisim_sim3 out{};
  out.q[0] = aw * bx + ax * bw + ay * bz - az * by;
  out.q[1] = aw * by - ax * bz + ay * bw + az * bx;
  out.q[2] = aw * bz + ax * by - ay * bx + az * bw;
  out.q[3] = aw * bw - ax * bx - ay * by - az * bz;
  double norm = 0.0;
  for (double part : out.q) norm += part * part;
  for (double& part : out.q) part /= std::sqrt(norm);
  // R t as t + 2 w (v x t) + 2 v x (v x t).
  const double* t = T_b_c.t;
  const double cx = ay * t[2] - az * t[1];
  const double cy = az * t[0] - ax * t[2];
  const double cz = ax * t[1] - ay * t[0];
  out.t[0] = T_a_b.s * (t[0] + 2.0 * (aw * cx + ay * cz - az * cy)) + T_a_b.t[0];
  out.t[1] = T_a_b.s * (t[1] + 2.0 * (aw * cy + az * cx - ax * cz)) + T_a_b.t[1];
  out.t[2] = T_a_b.s * (t[2] + 2.0 * (aw * cz + ax * cy - ay * cx)) + T_a_b.t[2];
  out.s = T_a_b.s * T_b_c.s;
  return out;
}

unisim_sim3 inverse(const unisim_sim3& T_a_b) {
  const unisim_sim3 turn = {{-T_a_b.q[0], -T_a_b.q[1], -T_a_b.q[2], T_a_b.q[3]}, {}, 1.0 / T_a_b.s};
  unisim_sim3 out =
      compose(turn, {{0.0, 0.0, 0.0, 1.0}, {T_a_b.t[0], T_a_b.t[1], T_a_b.t[2]}, 1.0});
  for (double& value : out.t) value = -value;
  out.s = turn.s;
  return out;
}

double distance(const double* a, const double* b) {
  return std::sqrt(std::pow(a[0] - b[0], 2) + std::pow(a[1] - b[1], 2) + std::pow(a[2] - b[2], 2));
}

}  // namespace unisim::pipeline
