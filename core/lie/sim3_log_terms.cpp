// SPDX-License-Identifier: MIT
// What the logarithm of one similarity is built from.
#include "core/lie/sim3_log_terms.hpp"

#include "core/base/math.hpp"
#include "core/lie/so3.hpp"

namespace unisim {

void sim3_log_terms(double x, double y, double z, double w, double s, Sim3LogTerms* out) {
  const double n2 = x * x + y * y + z * z;
  out->angle_factor = so3_log_factor(n2, w);
  out->sigma = math::log(s);
  out->coefficients = log_coefficients(out->angle_factor * out->angle_factor * n2, out->sigma);
}

}  // namespace unisim
