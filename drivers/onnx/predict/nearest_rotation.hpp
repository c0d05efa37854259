// SPDX-License-Identifier: MIT
// The rotation nearest to a matrix that a network calls one.
#pragma once

#include <Eigen/Geometry>

namespace unisim::onnx {

/// Rotation R with the largest tr(R^T M), the nearest in the Frobenius norm, also where M is a
/// reflection: the eigenvector of the largest eigenvalue of Horn's symmetric 4x4 matrix.
/// @param M finite
/// @return false when no rotation is nearest
bool nearest_rotation(const Eigen::Matrix3d& M, Eigen::Quaterniond* R);

}  // namespace unisim::onnx
