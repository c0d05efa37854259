// SPDX-License-Identifier: MIT
// Normal equations of a bundle adjustment with the points eliminated: assembly, solution, step.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "drivers/geometric/bundle/bundle_adjuster.hpp"
#include "drivers/geometric/bundle/bundle_problem.hpp"
#include "drivers/geometric/bundle/reprojection_residual.hpp"
#include "drivers/geometric/bundle/tile_cholesky.hpp"

namespace unisim::geometric {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using IntrinsicsMatrix = Eigen::Matrix<double, kIntrinsics, kIntrinsics>;

/// Schur complement of the points of a BundleProblem. Unknowns stand in slots of 6: one per free
/// camera in the order they were added, then one for the intrinsics (log f, k1, cx, cy,
/// readout, an idle row).
/// The elimination order of the Cholesky factorisation is the slot order, so cameras should be
/// added in time order.
class ReducedSystem {
 public:
  explicit ReducedSystem(const BundleCapacity& capacity);

  /// Gives slots to the unknowns and works out which blocks exist.
  /// @param hold_first the first camera is fixed if no other is
  /// @return false when there is no free unknown or no point that can be adjusted
  bool layout(const BundleProblem& problem, bool hold_first);

  /// Robust cost of the present state: points that layout() took in, and priors.
  double cost(const BundleProblem& problem, const BundleOptions& options) const;

  /// Builds the reduced system at the present state with damping lambda diag(H), and factorises it.
  /// @return false when it is not positive definite
  bool factorize(const BundleProblem& problem, const BundleOptions& options, double lambda);

  /// Solves for the step and moves cameras, points and intrinsics of `problem` by it.
  /// @return false, problem untouched: the step is not finite
  bool step(BundleProblem* problem);

  int slot_of_camera(int camera) const {
    return slots_[static_cast<std::size_t>(camera)];
  }  ///< -1: held
  int observation_count() const { return used_; }  ///< in the last factorize()
  bool point_active(int point) const { return active_[static_cast<std::size_t>(point)] != 0; }

  /// Factor of the last factorize(); slots as above, intrinsics last.
  const TileCholesky& factor() const { return matrix_; }
  int camera_slots() const { return camera_slots_; }
  /// Covariance of (log f, k1, cx, cy, readout) after the last factorize(); zero for what is held.
  IntrinsicsMatrix intrinsics_covariance() const;

  std::size_t memory_bytes() const;

 private:
  // One row of eliminated coupling: W L^-T of a slot, with V = L L^T of its point.
  struct Coupling {
    Eigen::Matrix<double, 6, 3> Y;
    std::int32_t slot;
  };
  // Diagonal block of one camera before elimination.
  struct CameraBlock {
    Matrix6d U;
    Eigen::Matrix<double, kIntrinsics, 6> UF;  // intrinsics by camera
  };
  // One point after elimination.
  struct PointFactor {
    Eigen::Matrix3d L;   // lower factor of the damped point block, diagonal inverted
    Eigen::Vector3d c;   // L^-1 (-gradient)
    std::int32_t first;  // in couplings_
    std::int32_t count;  // 0: not in this linearisation
  };
  struct PointSums;

  void mark_pattern(const BundleProblem& problem);
  void begin_linearization(const BundleProblem& problem, const BundleOptions& options);
  void linearize_point(const BundleProblem& problem, const BundleOptions& options, int point,
                       double lambda);
  int camera_coordinates(const BundleProblem& problem, const BundlePoint& point);
  void add_observation(const BundleProblem& problem, const BundleOptions& options, int observation,
                       const Eigen::Vector3d& y, PointSums* sums);
  void eliminate(const PointSums& sums, double lambda, PointFactor* factor);
  void subtract_couplings(const PointFactor& factor);
  void finish_assembly(const BundleProblem& problem, double lambda);

  bool has_intrinsics() const { return free_[0] || free_[1] || free_[2] || free_[4]; }
  int slot_count() const { return camera_slots_ + (has_intrinsics() ? 1 : 0); }

  TileCholesky matrix_;
  int camera_slots_ = 0;
  bool free_[kIntrinsics] = {};  // log f, k1, cx, cy, readout
  int used_ = 0;
  ResidualIntrinsics constants_ = {};
  IntrinsicsMatrix F_ = IntrinsicsMatrix::Zero();  // intrinsics block before elimination
  std::vector<std::int32_t> slots_;                // per camera
  std::vector<std::uint8_t> active_;               // per point
  std::vector<CameraBlock> cameras_;               // per camera slot
  std::vector<double> gradient_;                   // right-hand side, then the step
  std::vector<PointFactor> points_;
  std::vector<Coupling> couplings_;
  std::int32_t coupling_count_ = 0;
  std::vector<Eigen::Vector3d> scratch_;  // camera coordinates of one point's observations
};

}  // namespace unisim::geometric
