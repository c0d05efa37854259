// SPDX-License-Identifier: MIT
// The rotation nearest to a matrix that a network calls one.
#include "drivers/onnx/predict/nearest_rotation.hpp"

#include <Eigen/Eigenvalues>

namespace unisim::onnx {
namespace {

// The two largest eigenvalues closer than this share of the largest: any rotation between is as
// near.
constexpr double kDegenerate = 1e-3;

}  // namespace

bool nearest_rotation(const Eigen::Matrix3d& M, Eigen::Quaterniond* R) {
  const double trace = M.trace();
  Eigen::Matrix4d N;  // order w x y z
  N(0, 0) = trace;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    N(0, i + 1) = N(i + 1, 0) = M(k, j) - M(j, k);
    N(i + 1, i + 1) = 2 * M(i, i) - trace;
    N(i + 1, j + 1) = N(j + 1, i + 1) = M(i, j) + M(j, i);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(N);
  const Eigen::Vector4d& values = solver.eigenvalues();
  if (solver.info() != Eigen::Success || !(values[3] - values[2] > kDegenerate * values[3])) {
    return false;
  }
  const Eigen::Vector4d q = solver.eigenvectors().col(3);
  *R = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
  return true;
}

}  // namespace unisim::onnx
