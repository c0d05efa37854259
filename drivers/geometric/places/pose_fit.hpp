// SPDX-License-Identifier: MIT
// A pose by least squares on the observations that agree with it, in rounds of ever narrower gates.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/geometric/bundle/pose_solver.hpp"
#include "drivers/geometric/map/state.hpp"

namespace unisim::geometric {

inline constexpr int kFitRounds = 3;

/// Within `gate` pixels of where the pose says, and in front of the camera.
bool agrees(const CameraModel& camera, const CameraPose& pose, const PoseObservation& seen,
            double gate);

/// @param observations weights are set: 1 within the last gate, else 0
/// @param gates kFitRounds + 1, pixels at the reference diagonal: of each round, and at the end
/// @param[out] inlier flags within the last gate @return their number, 0: too few for a round
int fit_pose(const State& state, std::vector<PoseObservation>* observations, const double* gates,
             CameraPose* pose, std::vector<uint8_t>* inlier);

}  // namespace unisim::geometric
