// SPDX-License-Identifier: MIT
// Pose of one camera from known points: robust Levenberg-Marquardt.
#include "drivers/geometric/bundle/pose_solver.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace unisim::geometric {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

// What a point behind the camera costs: as much as this many scaled pixels.
constexpr double kBehindPx = 1000.0;
constexpr double kMaxLambda = 1e6;

// Inputs of one solve with the constants worked out.
struct PoseProblem {
  const CameraModel& camera;
  const PoseObservation* observations;
  int count;
  double scaled_focal;
  double inverse_scale;
  double cauchy2;
};

struct NormalEquations {
  Matrix6d H;
  Vector6d g;
  double cost;
  int used;
};

double cauchy_cost(double squared, double cauchy2) {
  return 0.5 * cauchy2 * std::log1p(squared / cauchy2);
}

// Residual at camera coordinates y in scaled pixels.
Eigen::Vector2d residual(const PoseProblem& problem, const PoseObservation& seen, double x,
                         double y) {
  return Eigen::Vector2d(problem.scaled_focal * x -
                             (seen.undistorted_px.x() - problem.camera.cx) * problem.inverse_scale,
                         problem.scaled_focal * y -
                             (seen.undistorted_px.y() - problem.camera.cy) * problem.inverse_scale);
}

void linearize(const PoseProblem& problem, const CameraPose& pose, NormalEquations* out) {
  out->H.setZero();
  out->g.setZero();
  out->cost = 0.0;
  out->used = 0;
  for (int i = 0; i < problem.count; ++i) {
    const PoseObservation& seen = problem.observations[i];
    if (!(seen.weight > 0.0)) continue;
    const Eigen::Vector3d point = pose.apply(seen.point_world);
    if (!(point.z() > kMinDepth)) {
      out->cost += seen.weight * cauchy_cost(kBehindPx * kBehindPx, problem.cauchy2);
      continue;
    }
    const double iz = 1.0 / point.z();
    const double x = point.x() * iz;
    const double y = point.y() * iz;
    const Eigen::Vector2d r = residual(problem, seen, x, y);
    const double squared = r.squaredNorm();
    out->cost += seen.weight * cauchy_cost(squared, problem.cauchy2);
    const double w = seen.weight / (1.0 + squared / problem.cauchy2);
    const double f = problem.scaled_focal;
    Vector6d j0;
    Vector6d j1;
    j0 << f * iz, 0.0, -f * x * iz, -f * x * y, f * (1.0 + x * x), -f * y;
    j1 << 0.0, f * iz, -f * y * iz, -f * (1.0 + y * y), f * x * y, f * x;
    const Vector6d w0 = w * j0;
    const Vector6d w1 = w * j1;
    out->H.noalias() += w0 * j0.transpose() + w1 * j1.transpose();
    out->g += w0 * r.x() + w1 * r.y();
    ++out->used;
  }
}

int count_inliers(const PoseProblem& problem, const CameraPose& pose, double limit,
                  std::uint8_t* inlier) {
  int inliers = 0;
  for (int i = 0; i < problem.count; ++i) {
    const PoseObservation& seen = problem.observations[i];
    const Eigen::Vector3d point = pose.apply(seen.point_world);
    const bool good =
        seen.weight > 0.0 && point.z() > kMinDepth &&
        residual(problem, seen, point.x() / point.z(), point.y() / point.z()).norm() < limit;
    if (inlier != nullptr) inlier[i] = good ? 1 : 0;
    if (good) ++inliers;
  }
  return inliers;
}

bool valid(const PoseProblem& problem, const CameraPose& start, const PoseOptions& options) {
  if (!(options.pixel_scale > 0.0) || !(options.cauchy > 0.0) || problem.count < 0) return false;
  if (!(problem.camera.focal_px > 0.0) || !std::isfinite(problem.camera.focal_px)) return false;
  if (!start.R.allFinite() || !start.t.allFinite()) return false;
  for (int i = 0; i < problem.count; ++i) {
    const PoseObservation& seen = problem.observations[i];
    if (!std::isfinite(seen.weight) || !seen.point_world.allFinite() ||
        !seen.undistorted_px.allFinite()) {
      return false;
    }
  }
  return true;
}

}  // namespace

PoseResult solve_pose(const CameraModel& camera, const CameraPose& start,
                      const PoseObservation* observations, int count, const PoseOptions& options,
                      std::uint8_t* inlier) {
  PoseResult result;
  result.pose = start;
  const PoseProblem problem = {camera,
                               observations,
                               count,
                               camera.focal_px / options.pixel_scale,
                               1.0 / options.pixel_scale,
                               options.cauchy * options.cauchy};
  if (!valid(problem, start, options)) return result;

  NormalEquations best;
  linearize(problem, start, &best);
  result.status = best.used >= 3 ? PoseStatus::kOk : PoseStatus::kTooFew;
  double lambda = 1e-4;
  bool done = result.status != PoseStatus::kOk;
  while (!done && result.iterations < options.max_iterations) {
    ++result.iterations;
    Matrix6d damped = best.H;
    damped.diagonal() += lambda * best.H.diagonal() + Vector6d::Constant(1e-12);
    const Vector6d step = -damped.ldlt().solve(best.g);
    const CameraPose moved = retract(result.pose, step);
    NormalEquations next;
    linearize(problem, moved, &next);
    if (next.cost < best.cost && step.allFinite()) {
      done = best.cost - next.cost < options.relative_tolerance * best.cost;
      result.pose = moved;
      best = next;
      lambda = std::fmax(0.1 * lambda, 1e-9);
    } else {
      done = next.cost - best.cost <= 1e-12 * best.cost || lambda > kMaxLambda;
      lambda *= 10.0;
    }
  }
  result.cost = best.cost;
  result.information = best.H;
  result.inliers = count_inliers(problem, result.pose, options.inlier, inlier);
  return result;
}

}  // namespace unisim::geometric
