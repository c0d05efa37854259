// SPDX-License-Identifier: MIT
// Composition of two similarities given as C structs.
#pragma once

#include "unisim/unisim.h"

namespace unisim::pipeline {

/// T_a_c = T_a_b * T_b_c. Quaternions are unit and stay so.
unisim_sim3 compose(const unisim_sim3& T_a_b, const unisim_sim3& T_b_c);

}  // namespace unisim::pipeline
