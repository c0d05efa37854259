// SPDX-License-Identifier: MIT
// What a bundle adjustment says about the precision of camera centres and intrinsics.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "drivers/common/median.hpp"
#include "drivers/geometric/bundle/bundle_adjuster.hpp"
#include "drivers/geometric/bundle/bundle_workspace.hpp"
#include "drivers/geometric/bundle/reduced_system.hpp"
#include "drivers/geometric/bundle/robust_cost.hpp"

namespace unisim::geometric {
namespace {

// Just enough damping to factorise a system whose scale is free; the projection takes its effect
// out.
constexpr double kGaugeLambda = 1e-10;
// Median of the norm of a two-dimensional unit normal variable.
constexpr double kRayleighMedian = 1.1774;
// Precision below which pixel positions are never trusted, scaled pixels.
constexpr double kResidualFloor = 0.01;
// Of the cost: see precision(). Chosen so that the true focal length lies within two of its
// standard deviations on all recordings but two; drivers/geometric/README.md has the table.
constexpr double kModelShare = 0.01;

/// How far an unknown can go. `variance` is its own where residuals are unit normal ones; its prior
/// does not care how large they are.
double reach(double variance, double prior_sigma, double residual_variance) {
  if (!(variance > 0.0)) return 0.0;
  const double prior = prior_sigma > 0.0 ? 1.0 / (prior_sigma * prior_sigma) : 0.0;
  const double seen = std::max(0.0, 1.0 / variance - prior);
  return 1.0 / std::sqrt(seen / residual_variance + prior);
}

}  // namespace

/// Displacement of the centres of some cameras relative to the pose of one of them, with the scale
/// direction taken out, as linear functions of the camera unknowns.
class BundleAdjuster::CenterMap {
 public:
  CenterMap(const BundleProblem& problem, const ReducedSystem& system, const std::int32_t* cameras,
            int count)
      : problem_(problem), system_(system), cameras_(cameras), count_(count) {
    reference_ = cameras[count / 2];
    for (int i = 0; i < count; ++i) spread_ += relative(cameras[i]).squaredNorm();
    spread_ = std::sqrt(spread_);
  }

  bool degenerate() const { return !(spread_ > 0.0); }
  int count() const { return count_; }

  /// Adds to `x` the gradient, by the unknowns, of coordinate `axis` of camera number `i` (in the
  /// frame of the reference camera), its share of the change of scale removed.
  void gradient(int i, int axis, double* x) const {
    add(cameras_[i], Eigen::Vector3d::Unit(axis), x);
    const double share = relative(cameras_[i])[axis] / spread_;
    for (int k = 0; k < count_; ++k) {
      add(cameras_[k], -share / spread_ * relative(cameras_[k]), x);
    }
  }

 private:
  // Centre of a camera in the frame of the reference camera.
  Eigen::Vector3d relative(int camera) const {
    return problem_.camera(reference_).pose.apply(problem_.camera(camera).pose.center());
  }

  // x += d (direction . relative centre) / d unknowns. A camera moved by (translation, rotation)
  // moves its centre by -R^T translation.
  void add(int camera, const Eigen::Vector3d& direction, double* x) const {
    if (camera == reference_) return;
    const int slot = system_.slot_of_camera(camera);
    const CameraPose& reference = problem_.camera(reference_).pose;
    if (slot >= 0) {
      const Eigen::Matrix3d& R = problem_.camera(camera).pose.R;
      Eigen::Map<Eigen::Vector3d>(x + 6 * slot) -= R * (reference.R.transpose() * direction);
    }
    const int reference_slot = system_.slot_of_camera(reference_);
    if (reference_slot >= 0) {
      Eigen::Map<Vector6d> own(x + 6 * reference_slot);
      own.head<3>() += direction;
      own.tail<3>() += relative(camera).cross(direction);
    }
  }

  const BundleProblem& problem_;
  const ReducedSystem& system_;
  const std::int32_t* cameras_;
  int count_;
  int reference_ = 0;
  double spread_ = 0.0;
};

BundlePrecision BundleAdjuster::precision(const BundleProblem& problem,
                                          const BundleOptions& options, const std::int32_t* cameras,
                                          int count) {
  BundlePrecision out;
  if (count < 0 || count == 1 || count == 2 ||
      prepare(problem, options, true) != BundleStatus::kIterationCap)
    return out;
  for (int i = 0; i < count; ++i) {
    if (cameras[i] < 0 || cameras[i] >= problem.camera_count()) return out;
  }
  if (!system_->factorize(problem, options, kGaugeLambda)) return out;
  measure_residuals(problem, options, cameras, count, &out);
  if (system_->observation_count() == 0 || !(out.median_depth > 0.0)) return out;
  if (count > 0) {
    const CenterMap map(problem, *system_, cameras, count);
    if (map.degenerate()) return out;
    out.center_sigma = std::sqrt(center_variance(map)) * out.residual_sigma / out.median_depth;
  }
  const IntrinsicsMatrix covariance = system_->intrinsics_covariance();
  out.log_focal_sigma = std::sqrt(covariance(0, 0)) * out.residual_sigma;
  out.k1_sigma = std::sqrt(covariance(1, 1)) * out.residual_sigma;
  out.readout_sigma_s = std::sqrt(covariance(4, 4)) * out.residual_sigma;
  const double noise = out.residual_sigma * out.residual_sigma;
  const double one_way = 2.0 * kModelShare * system_->cost(problem, options);
  out.log_focal_reach =
      reach(covariance(0, 0), problem.intrinsics.log_focal_sigma, noise + one_way);
  out.valid = std::isfinite(out.center_sigma) && std::isfinite(out.log_focal_sigma) &&
              std::isfinite(out.k1_sigma);
  return out;
}

double BundleAdjuster::center_variance(const CenterMap& map) {
  const TileCholesky& factor = system_->factor();
  double* x = workspace_->solution.data();
  const int camera_size = 6 * system_->camera_slots();
  double sum = 0.0;
  for (int i = 0; i < map.count(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      std::fill(x, x + factor.dimension(), 0.0);
      map.gradient(i, axis, x);
      factor.forward(x, 0);
      // Leaving the rows of the intrinsics out takes them as known.
      sum += Eigen::Map<const Eigen::VectorXd>(x, camera_size).squaredNorm();
    }
  }
  return sum / (map.count() - 1);
}

void BundleAdjuster::measure_residuals(const BundleProblem& problem, const BundleOptions& options,
                                       const std::int32_t* cameras, int count,
                                       BundlePrecision* out) {
  const ResidualIntrinsics constants = residual_intrinsics(problem.intrinsics, options.pixel_scale);
  std::vector<double>& norms = workspace_->norms;
  std::vector<double>& depths = workspace_->depths;
  norms.clear();
  depths.clear();
  for (int p = 0; p < problem.point_count(); ++p) {
    if (!system_->point_active(p)) continue;
    const BundlePoint& point = problem.point(p);
    for (int o = point.first; o < point.first + point.count; ++o) {
      const BundleObservation& seen = problem.observation(o);
      const Eigen::Vector3d y = problem.camera(seen.camera).pose.apply(point.position);
      if (!(seen.weight > 0.0) || !(y.z() > kMinDepth)) continue;
      norms.push_back(reprojection_value(constants, y, seen).norm());
      if (count == 0 || std::find(cameras, cameras + count, seen.camera) != cameras + count) {
        depths.push_back(y.z());
      }
    }
  }
  const double norm = norms.empty() ? 0.0 : drivers::median(&norms);
  out->residual_sigma = std::hypot(norm / kRayleighMedian, kResidualFloor);
  out->median_depth = depths.empty() ? 0.0 : drivers::median(&depths);
}

}  // namespace unisim::geometric
