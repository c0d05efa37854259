// SPDX-License-Identifier: MIT
// Absolute trajectory error: distances of positions after alignment.
#include "tools/eval/ate.hpp"

namespace unisim::eval {

Ate absolute_trajectory_error(const Trajectory& ground_truth, const Trajectory& estimate,
                              Alignment alignment, double max_dt_s) {
  Ate ate;
  ate.pairs = associate(ground_truth, estimate, max_dt_s);
  std::vector<Eigen::Vector3d> positions;
  for (const IndexPair& pair : ate.pairs) {
    ate.time_s.push_back(estimate.poses[pair.estimate].time_s);
    ate.truth_position.push_back(ground_truth.poses[pair.ground_truth].t);
    positions.push_back(estimate.poses[pair.estimate].t);
  }
  ate.T_truth_estimate = align(positions, ate.truth_position, alignment);
  for (size_t k = 0; k < positions.size(); ++k) {
    ate.aligned_position.push_back(ate.T_truth_estimate * positions[k]);
    ate.distance.push_back((ate.aligned_position[k] - ate.truth_position[k]).norm());
  }
  ate.error = summarise(ate.distance);
  return ate;
}

}  // namespace unisim::eval
