// SPDX-License-Identifier: MIT
// Normal equations of a bundle adjustment with the points eliminated: assembly, solution, step.
#include "drivers/geometric/bundle/reduced_system.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/geometric/bundle/robust_cost.hpp"

namespace unisim::geometric {
namespace {

// Largest change of log f in one step; longer steps are shortened as a whole.
constexpr double kMaxLogFocalStep = 0.3;
// Added to the diagonal of a point block relative to its trace: a point seen along one line only.
constexpr double kPointFloor = 1e-12;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

double prior_information(double sigma) { return sigma > 0.0 ? 1.0 / (sigma * sigma) : 0.0; }

}  // namespace

struct ReducedSystem::PointSums {
  Eigen::Matrix3d V = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();  // minus gradient
  Eigen::Matrix<double, kIntrinsics, 3> WF = Eigen::Matrix<double, kIntrinsics, 3>::Zero();
};

ReducedSystem::ReducedSystem(const BundleCapacity& capacity) : matrix_(capacity.free_cameras + 1) {
  slots_.resize(at(capacity.cameras));
  active_.resize(at(capacity.points));
  cameras_.resize(at(capacity.free_cameras));
  gradient_.resize(at(TileCholesky::kBlock * (capacity.free_cameras + 1) + TileCholesky::kTile));
  points_.resize(at(capacity.points));
  couplings_.resize(at(capacity.observations) + at(capacity.points));
  scratch_.resize(at(capacity.cameras));
}

bool ReducedSystem::layout(const BundleProblem& problem, bool hold_first) {
  free_[0] = problem.intrinsics.free_focal;
  free_[1] = problem.intrinsics.free_k1;
  free_[2] = free_[3] = problem.intrinsics.free_center;
  free_[4] = problem.intrinsics.free_readout;
  camera_slots_ = 0;
  const bool none_fixed = !problem.any_fixed();
  for (int i = 0; i < problem.camera_count(); ++i) {
    const bool hold = problem.camera(i).fixed || (hold_first && none_fixed && i == 0);
    slots_[at(i)] = hold ? -1 : camera_slots_++;
  }
  int active = 0;
  for (int p = 0; p < problem.point_count(); ++p) {
    const BundlePoint& point = problem.point(p);
    int seen = 0;
    for (int o = point.first; o < point.first + point.count; ++o) {
      seen += problem.observation(o).weight > 0.0 ? 1 : 0;
    }
    active_[at(p)] = seen >= 2 ? 1 : 0;
    active += active_[at(p)];
  }
  mark_pattern(problem);
  return active > 0;
}

void ReducedSystem::mark_pattern(const BundleProblem& problem) {
  matrix_.begin(slot_count());
  for (int p = 0; p < problem.point_count(); ++p) {
    if (!active_[at(p)]) continue;
    const BundlePoint& point = problem.point(p);
    for (int a = point.first; a < point.first + point.count; ++a) {
      const int row = slots_[at(problem.observation(a).camera)];
      for (int b = point.first; b < a && row >= 0; ++b) {
        const int column = slots_[at(problem.observation(b).camera)];
        if (column >= 0) matrix_.mark(row, column);
      }
    }
  }
  for (int i = 0; i < camera_slots_ && has_intrinsics(); ++i) matrix_.mark(camera_slots_, i);
  matrix_.analyze();
}

double ReducedSystem::cost(const BundleProblem& problem, const BundleOptions& options) const {
  const ResidualIntrinsics constants = residual_intrinsics(problem.intrinsics, options.pixel_scale);
  double sum = intrinsics_cost(problem.intrinsics);
  for (int p = 0; p < problem.point_count(); ++p) {
    if (active_[at(p)]) sum += point_cost(problem, problem.point(p), constants, options.huber);
  }
  return sum;
}

void ReducedSystem::begin_linearization(const BundleProblem& problem,
                                        const BundleOptions& options) {
  constants_ = residual_intrinsics(problem.intrinsics, options.pixel_scale);
  used_ = 0;
  coupling_count_ = 0;
  F_.setZero();
  for (int i = 0; i < camera_slots_; ++i) {
    cameras_[at(i)].U.setZero();
    cameras_[at(i)].UF.setZero();
  }
  std::fill(gradient_.begin(), gradient_.begin() + matrix_.dimension(), 0.0);
  matrix_.clear();
}

int ReducedSystem::camera_coordinates(const BundleProblem& problem, const BundlePoint& point) {
  int in_front = 0;
  for (int i = 0; i < point.count; ++i) {
    const BundleObservation& seen = problem.observation(point.first + i);
    Eigen::Vector3d& y = scratch_[at(i)];
    y = problem.camera(seen.camera).pose.apply(point.position);
    if (!(seen.weight > 0.0)) y.z() = -1.0;
    in_front += y.z() > kMinDepth ? 1 : 0;
  }
  return in_front;
}

void ReducedSystem::add_observation(const BundleProblem& problem, const BundleOptions& options,
                                    int observation, const Eigen::Vector3d& y, PointSums* sums) {
  const BundleObservation& seen = problem.observation(observation);
  const Eigen::Vector2d value = reprojection_value(constants_, y, seen);
  const double root = std::sqrt(huber_weight(value.norm(), options.huber));
  const Eigen::Vector2d r = root * value;
  ReprojectionResidual J;
  reprojection_jacobian(constants_, problem.camera(seen.camera).pose.R, y, seen, root * seen.weight,
                        &J);
  ++used_;
  sums->V.noalias() += J.point0 * J.point0.transpose() + J.point1 * J.point1.transpose();
  sums->b -= r.x() * J.point0 + r.y() * J.point1;
  const int slot = slots_[at(seen.camera)];
  if (slot >= 0) {
    CameraBlock& camera = cameras_[at(slot)];
    camera.U.noalias() += J.camera0 * J.camera0.transpose() + J.camera1 * J.camera1.transpose();
    Eigen::Map<Vector6d>(&gradient_[at(6 * slot)]) -= r.x() * J.camera0 + r.y() * J.camera1;
    Coupling& coupling = couplings_[at(coupling_count_++)];
    coupling.slot = slot;
    coupling.Y.noalias() = J.camera0 * J.point0.transpose() + J.camera1 * J.point1.transpose();
    if (has_intrinsics()) {
      camera.UF.noalias() +=
          J.intrinsics0 * J.camera0.transpose() + J.intrinsics1 * J.camera1.transpose();
    }
  }
  if (has_intrinsics()) {
    F_.noalias() +=
        J.intrinsics0 * J.intrinsics0.transpose() + J.intrinsics1 * J.intrinsics1.transpose();
    Eigen::Map<IntrinsicsVector>(&gradient_[at(6 * camera_slots_)]) -=
        r.x() * J.intrinsics0 + r.y() * J.intrinsics1;
    sums->WF.noalias() +=
        J.intrinsics0 * J.point0.transpose() + J.intrinsics1 * J.point1.transpose();
  }
}

void ReducedSystem::eliminate(const PointSums& sums, double lambda, PointFactor* factor) {
  Eigen::Matrix3d V = sums.V;
  const double floor = kPointFloor * V.trace();
  for (int d = 0; d < 3; ++d) V(d, d) += lambda * V(d, d) + floor;
  const double l00 = 1.0 / std::sqrt(V(0, 0));
  const double l10 = V(1, 0) * l00;
  const double l20 = V(2, 0) * l00;
  const double l11 = 1.0 / std::sqrt(std::max(V(1, 1) - l10 * l10, floor));
  const double l21 = (V(2, 1) - l20 * l10) * l11;
  const double l22 = 1.0 / std::sqrt(std::max(V(2, 2) - l20 * l20 - l21 * l21, floor));
  factor->L << l00, 0.0, 0.0, l10, l11, 0.0, l20, l21, l22;
  factor->c.x() = sums.b.x() * l00;
  factor->c.y() = (sums.b.y() - l10 * factor->c.x()) * l11;
  factor->c.z() = (sums.b.z() - l20 * factor->c.x() - l21 * factor->c.y()) * l22;
  for (int i = factor->first; i < factor->first + factor->count; ++i) {
    Eigen::Matrix<double, 6, 3>& Y = couplings_[at(i)].Y;
    Y.col(0) *= l00;
    Y.col(1) = (Y.col(1) - l10 * Y.col(0)) * l11;
    Y.col(2) = (Y.col(2) - l20 * Y.col(0) - l21 * Y.col(1)) * l22;
  }
}

void ReducedSystem::subtract_couplings(const PointFactor& factor) {
  const Coupling* first = &couplings_[at(factor.first)];
  for (int a = 0; a < factor.count; ++a) {
    const Coupling& row = first[a];
    Eigen::Map<Vector6d>(&gradient_[at(6 * row.slot)]).noalias() -= row.Y * factor.c;
    for (int b = 0; b <= a; ++b) {
      TileCholesky::Block block = matrix_.block(row.slot, first[b].slot);
      block.noalias() -= row.Y.lazyProduct(first[b].Y.transpose());
    }
  }
}

void ReducedSystem::linearize_point(const BundleProblem& problem, const BundleOptions& options,
                                    int index, double lambda) {
  const BundlePoint& point = problem.point(index);
  PointFactor& factor = points_[at(index)];
  factor.first = coupling_count_;
  factor.count = 0;
  factor.c.setZero();
  if (camera_coordinates(problem, point) < 2) {
    factor.L.setZero();
    return;
  }
  PointSums sums;
  for (int i = 0; i < point.count; ++i) {
    if (scratch_[at(i)].z() > kMinDepth) {
      add_observation(problem, options, point.first + i, scratch_[at(i)], &sums);
    }
  }
  if (has_intrinsics()) {
    Coupling& coupling = couplings_[at(coupling_count_++)];
    coupling.slot = camera_slots_;
    coupling.Y.setZero();
    for (int row = 0; row < kIntrinsics; ++row) {
      if (free_[row]) coupling.Y.row(row) = sums.WF.row(row);
    }
  }
  factor.count = coupling_count_ - factor.first;
  eliminate(sums, lambda, &factor);
  subtract_couplings(factor);
}

void ReducedSystem::finish_assembly(const BundleProblem& problem, double lambda) {
  for (int i = 0; i < camera_slots_; ++i) {
    const Matrix6d& U = cameras_[at(i)].U;
    TileCholesky::Block block = matrix_.block(i, i);
    block += U;
    block.diagonal() += lambda * U.diagonal();
    if (!(U.trace() > 0.0)) block.diagonal().setOnes();
  }
  if (!has_intrinsics()) return;
  const BundleIntrinsics& in = problem.intrinsics;
  Eigen::Map<IntrinsicsVector> gradient(&gradient_[at(6 * camera_slots_)]);
  IntrinsicsVector off;
  off << in.log_focal - in.log_focal_mean, in.k1 - in.k1_mean, in.cx - in.cx_mean,
      in.cy - in.cy_mean, in.readout_s - in.readout_mean_s;
  IntrinsicsVector information;
  information << prior_information(in.log_focal_sigma), prior_information(in.k1_sigma),
      prior_information(in.center_sigma_px), prior_information(in.center_sigma_px),
      prior_information(in.readout_sigma_s);
  gradient -= information.cwiseProduct(off);
  F_.diagonal() += information;
  TileCholesky::Block corner = matrix_.block(camera_slots_, camera_slots_);
  corner.topLeftCorner<kIntrinsics, kIntrinsics>() += F_;
  corner.diagonal().head<kIntrinsics>() += lambda * F_.diagonal();
  for (int row = 0; row < 6; ++row) {
    const bool used = row < kIntrinsics && free_[row] && F_(row, row) > 0.0;
    if (used) {
      for (int i = 0; i < camera_slots_; ++i) {
        matrix_.block(camera_slots_, i).row(row) += cameras_[at(i)].UF.row(row);
      }
      continue;
    }
    corner.row(row).setZero();
    corner.col(row).setZero();
    corner(row, row) = 1.0;
    gradient_[at(6 * camera_slots_ + row)] = 0.0;
  }
}

bool ReducedSystem::factorize(const BundleProblem& problem, const BundleOptions& options,
                              double lambda) {
  begin_linearization(problem, options);
  for (int p = 0; p < problem.point_count(); ++p) {
    points_[at(p)].count = 0;
    if (active_[at(p)]) linearize_point(problem, options, p, lambda);
  }
  finish_assembly(problem, lambda);
  return matrix_.factorize();
}

bool ReducedSystem::step(BundleProblem* problem) {
  matrix_.forward(gradient_.data(), 0);
  matrix_.backward(gradient_.data());
  const int size = 6 * slot_count();
  const double* intrinsics = &gradient_[at(6 * camera_slots_)];
  Eigen::Map<Eigen::VectorXd> dx(gradient_.data(), size);
  if (!dx.allFinite()) return false;
  if (has_intrinsics() && std::abs(intrinsics[0]) > kMaxLogFocalStep) {
    dx *= kMaxLogFocalStep / std::abs(intrinsics[0]);
  }
  for (int i = 0; i < problem->camera_count(); ++i) {
    const int slot = slots_[at(i)];
    if (slot < 0) continue;
    CameraPose& pose = problem->camera(i).pose;
    pose = retract(pose, dx.segment<6>(6 * slot));
  }
  for (int p = 0; p < problem->point_count(); ++p) {
    const PointFactor& factor = points_[at(p)];
    if (!active_[at(p)]) continue;
    Eigen::Vector3d b = factor.c;
    for (int i = factor.first; i < factor.first + factor.count; ++i) {
      const Coupling& coupling = couplings_[at(i)];
      b.noalias() -= coupling.Y.transpose() * dx.segment<6>(6 * coupling.slot);
    }
    const Eigen::Matrix3d& L = factor.L;
    b.z() *= L(2, 2);
    b.y() = (b.y() - L(2, 1) * b.z()) * L(1, 1);
    b.x() = (b.x() - L(1, 0) * b.y() - L(2, 0) * b.z()) * L(0, 0);
    problem->point(p).position += b;
  }
  BundleIntrinsics& in = problem->intrinsics;
  if (free_[0]) in.log_focal += intrinsics[0];
  if (free_[1]) in.k1 += intrinsics[1];
  if (free_[2]) in.cx += intrinsics[2];
  if (free_[3]) in.cy += intrinsics[3];
  if (free_[4]) in.readout_s += intrinsics[4];
  return true;
}

IntrinsicsMatrix ReducedSystem::intrinsics_covariance() const {
  if (!has_intrinsics()) return IntrinsicsMatrix::Zero();
  // The intrinsics come last, so their corner of L is the factor of their marginal information.
  const IntrinsicsMatrix L =
      matrix_.diagonal_block(camera_slots_).topLeftCorner<kIntrinsics, kIntrinsics>();
  const IntrinsicsMatrix inverse =
      L.triangularView<Eigen::Lower>().solve(IntrinsicsMatrix::Identity());
  IntrinsicsMatrix covariance = inverse.transpose() * inverse;
  for (int i = 0; i < kIntrinsics; ++i) {
    if (free_[i]) continue;
    covariance.row(i).setZero();
    covariance.col(i).setZero();
  }
  return covariance;
}

std::size_t ReducedSystem::memory_bytes() const {
  return matrix_.memory_bytes() + slots_.capacity() * sizeof(slots_[0]) + active_.capacity() +
         cameras_.capacity() * sizeof(cameras_[0]) + gradient_.capacity() * sizeof(gradient_[0]) +
         points_.capacity() * sizeof(points_[0]) + couplings_.capacity() * sizeof(couplings_[0]) +
         scratch_.capacity() * sizeof(scratch_[0]);
}

}  // namespace unisim::geometric
