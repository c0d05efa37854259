// SPDX-License-Identifier: MIT
// A pose by least squares on the observations that agree with it.
#include "drivers/geometric/places/pose_fit.hpp"

namespace unisim::geometric {

namespace {
constexpr int kMinForFit = 6;
constexpr double kFitWidth = 2.0;
constexpr int kFitIterations = 10;
}  // namespace

bool agrees(const CameraModel& camera, const CameraPose& pose, const PoseObservation& seen,
            double gate) {
  Eigen::Vector2d at;
  return camera.project_undistorted(pose.apply(seen.point_world), &at) &&
         (at - seen.undistorted_px).norm() < gate;
}

int fit_pose(const State& state, std::vector<PoseObservation>* observations, const double* gates,
             CameraPose* pose, std::vector<uint8_t>* inlier) {
  const CameraModel& camera = state.intrinsics.camera;
  PoseOptions options;
  options.pixel_scale = state.pixel_scale;
  options.cauchy = kFitWidth;
  options.max_iterations = kFitIterations;
  const auto within = [&](double gate) {
    int count = 0;
    for (size_t i = 0; i < observations->size(); ++i) {
      PoseObservation& seen = (*observations)[i];
      const bool near = agrees(camera, *pose, seen, gate * state.pixel_scale);
      (*inlier)[i] = near ? 1 : 0;
      seen.weight = near ? 1.0 : 0.0;
      count += near ? 1 : 0;
    }
    return count;
  };
  inlier->assign(observations->size(), 0);
  for (int round = 0; round < kFitRounds; ++round) {
    if (within(gates[round]) < kMinForFit) return 0;
    const PoseResult result = solve_pose(camera, *pose, observations->data(),
                                         static_cast<int>(observations->size()), options, nullptr);
    if (result.status != PoseStatus::kOk || !result.pose.t.allFinite()) return 0;
    *pose = result.pose;
  }
  return within(gates[kFitRounds]);
}

}  // namespace unisim::geometric
