// SPDX-License-Identifier: MIT
// Composition and inverse of similarities given as C structs, distance of two points.
#pragma once

#include "unisim/unisim.h"

namespace unisim::pipeline {

/// T_a_c = T_a_b * T_b_c. Quaternions are unit and stay so.
unisim_sim3 compose(const unisim_sim3& T_a_b, const unisim_sim3& T_b_c);

/// T_b_a of T_a_b.
unisim_sim3 inverse(const unisim_sim3& T_a_b);

/// Between two points of three numbers each.
double distance(const double* a, const double* b);

}  // namespace unisim::pipeline
