// SPDX-License-Identifier: MIT
// Levenberg-Marquardt on a BundleProblem: points eliminated, reduced camera system by Cholesky.
#include "drivers/geometric/bundle/bundle_adjuster.hpp"

#include <cmath>

#include "drivers/geometric/bundle/bundle_workspace.hpp"
#include "drivers/geometric/bundle/reduced_system.hpp"
#include "drivers/geometric/bundle/world_move.hpp"

namespace unisim::geometric {
namespace {

constexpr double kMinLambda = 1e-9;
constexpr double kMaxLambda = 1e8;
constexpr double kAccepted = 0.1;  // factor on lambda after a good step
constexpr double kRefused = 10.0;  // and after a bad one

bool fits(const BundleProblem& problem, const BundleCapacity& capacity) {
  return problem.camera_count() <= capacity.cameras &&
         problem.free_camera_count() <= capacity.free_cameras &&
         problem.point_count() <= capacity.points &&
         problem.observation_count() <= capacity.observations;
}

bool finite(const BundleIntrinsics& in) {
  return std::isfinite(in.log_focal) && std::isfinite(in.k1) && std::isfinite(in.cx) &&
         std::isfinite(in.cy) && std::isfinite(in.log_focal_mean) &&
         std::isfinite(in.log_focal_sigma) && std::isfinite(in.k1_mean) &&
         std::isfinite(in.k1_sigma) && std::isfinite(in.cx_mean) && std::isfinite(in.cy_mean) &&
         std::isfinite(in.center_sigma_px) && std::isfinite(in.readout_s) &&
         std::isfinite(in.readout_mean_s) && std::isfinite(in.readout_sigma_s);
}

bool valid(const BundleProblem& problem, const BundleOptions& options) {
  if (!(options.pixel_scale > 0.0) || !(options.huber > 0.0) || !(options.initial_lambda > 0.0) ||
      options.max_iterations < 0 || !finite(problem.intrinsics)) {
    return false;
  }
  for (int i = 0; i < problem.camera_count(); ++i) {
    const CameraPose& pose = problem.camera(i).pose;
    if (!pose.R.allFinite() || !pose.t.allFinite()) return false;
  }
  for (int i = 0; i < problem.point_count(); ++i) {
    if (!problem.point(i).position.allFinite()) return false;
  }
  for (int i = 0; i < problem.observation_count(); ++i) {
    const BundleObservation& seen = problem.observation(i);
    if (!std::isfinite(seen.u) || !std::isfinite(seen.v) || !std::isfinite(seen.weight) ||
        !seen.sway.allFinite()) {
      return false;
    }
  }
  return true;
}

/// Moves all so that the first camera is where it was.
void bring_back(const CameraPose& first, BundleProblem* problem) {
  const WorldMove move = WorldMove::between(problem->camera(0).pose, first, 1.0);
  for (int i = 0; i < problem->camera_count(); ++i) {
    CameraPose& pose = problem->camera(i).pose;
    pose = move.apply(pose);
  }
  problem->camera(0).pose = first;
  for (int i = 0; i < problem->point_count(); ++i) {
    Eigen::Vector3d& position = problem->point(i).position;
    position = move.apply(position);
  }
}

}  // namespace

BundleAdjuster::BundleAdjuster(const BundleCapacity& capacity)
    : capacity_(capacity),
      system_(std::make_unique<ReducedSystem>(capacity)),
      workspace_(std::make_unique<Workspace>(capacity)) {}

BundleAdjuster::~BundleAdjuster() = default;

BundleStatus BundleAdjuster::prepare(const BundleProblem& problem, const BundleOptions& options,
                                     bool hold_first) {
  if (!fits(problem, capacity_)) return BundleStatus::kTooLarge;
  if (!valid(problem, options)) return BundleStatus::kInvalidInput;
  return system_->layout(problem, hold_first) ? BundleStatus::kIterationCap
                                              : BundleStatus::kNothingToDo;
}

BundleResult BundleAdjuster::solve(BundleProblem* problem, const BundleOptions& options) {
  BundleResult result;
  result.status = prepare(*problem, options, false);
  if (result.status != BundleStatus::kIterationCap) return result;
  const CameraPose first = problem->camera(0).pose;

  result.lambda = options.initial_lambda;
  result.initial_cost = system_->cost(*problem, options);
  result.final_cost = result.initial_cost;
  while (result.iterations < options.max_iterations &&
         result.status == BundleStatus::kIterationCap) {
    ++result.iterations;
    result.status = iterate(problem, options, &result);
  }
  if (!problem->any_fixed()) bring_back(first, problem);
  return result;
}

BundleStatus BundleAdjuster::iterate(BundleProblem* problem, const BundleOptions& options,
                                     BundleResult* result) {
  const bool solvable = system_->factorize(*problem, options, result->lambda);
  result->observations = system_->observation_count();
  if (result->observations == 0) return BundleStatus::kNothingToDo;
  if (solvable) {
    workspace_->save(*problem);
    const bool moved = system_->step(problem);
    const double cost = moved ? system_->cost(*problem, options) : result->final_cost;
    const double gain = result->final_cost - cost;
    const double small = options.relative_tolerance * result->final_cost;
    if (moved && gain > 0.0) {
      result->final_cost = cost;
      result->lambda = std::fmax(kAccepted * result->lambda, kMinLambda);
      return gain <= small ? BundleStatus::kConverged : BundleStatus::kIterationCap;
    }
    workspace_->restore(problem);
    if (moved && -gain <= small) return BundleStatus::kConverged;
  }
  result->lambda *= kRefused;
  return result->lambda > kMaxLambda ? BundleStatus::kNoDescent : BundleStatus::kIterationCap;
}

std::size_t BundleAdjuster::memory_bytes() const {
  return system_->memory_bytes() + workspace_->memory_bytes();
}

}  // namespace unisim::geometric
