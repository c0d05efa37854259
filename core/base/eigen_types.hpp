// SPDX-License-Identifier: MIT
// The fixed-size Eigen types of core.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/base/tangent_dim.hpp"

namespace unisim {

// Unaligned storage: the layout must not depend on the instruction set a file is compiled for.
using Vec3 = Eigen::Matrix<double, 3, 1, Eigen::DontAlign>;
using Vec7 = Eigen::Matrix<double, 7, 1, Eigen::DontAlign>;
using Mat3 = Eigen::Matrix<double, 3, 3, Eigen::DontAlign>;
using Mat7 = Eigen::Matrix<double, 7, 7, Eigen::DontAlign>;
using Quat = Eigen::Quaternion<double, Eigen::DontAlign>;

}  // namespace unisim
