// SPDX-License-Identifier: MIT
// Dimension of the tangent space, for files that do without Eigen.
#pragma once

namespace unisim {

/// Dimension of the tangent space of Sim(3): translation 3, rotation 3, log-scale 1.
inline constexpr int kTangentDim = 7;

}  // namespace unisim
