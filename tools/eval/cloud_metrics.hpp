// SPDX-License-Identifier: MIT
// How near a reconstructed cloud is to the true one.
#pragma once

#include "tools/eval/alignment.hpp"
#include "tools/eval/ply_cloud.hpp"
#include "tools/eval/statistics.hpp"

namespace unisim::eval {

/// Distances between nearest neighbours, in the unit of the ground truth.
struct CloudMetrics {
  Statistics accuracy;      ///< from each estimated point to the nearest true one
  Statistics completeness;  ///< from each true point to the nearest estimated one
  double chamfer = 0;       ///< mean of the two root mean squares
  size_t beyond = 0;        ///< distances cut to max_distance
};

/// @param T_truth_estimate applied to the estimate first
/// @param max_distance     larger distances count as this; 0: no limit
/// @throws InputError when a moved point is not near
CloudMetrics compare_clouds(const Cloud& ground_truth, const Cloud& estimate,
                            const Similarity& T_truth_estimate, double max_distance);

}  // namespace unisim::eval
