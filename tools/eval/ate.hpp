// SPDX-License-Identifier: MIT
// Absolute trajectory error: distances of positions after alignment.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tools/eval/alignment.hpp"
#include "tools/eval/association.hpp"
#include "tools/eval/statistics.hpp"
#include "tools/eval/trajectory.hpp"

namespace unisim::eval {

/// One entry per associated pair in all vectors, in the order of the shorter trajectory.
struct Ate {
  Statistics error;             ///< unit of the ground truth
  Similarity T_truth_estimate;  ///< the alignment; its s is the scale
  std::vector<IndexPair> pairs;
  std::vector<double> time_s;    ///< of the estimate
  std::vector<double> distance;  ///< error of each pair
  std::vector<Eigen::Vector3d> truth_position;
  std::vector<Eigen::Vector3d> aligned_position;  ///< of the estimate, in the frame of the truth
};

/// @param max_dt_s largest time difference of a pair
/// @throws InputError as associate() and align()
Ate absolute_trajectory_error(const Trajectory& ground_truth, const Trajectory& estimate,
                              Alignment alignment, double max_dt_s);

}  // namespace unisim::eval
