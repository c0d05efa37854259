// SPDX-License-Identifier: MIT
// How far poses can be believed: their errors over the standard deviations a run gives them.
#include "tools/eval/consistency.hpp"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

namespace unisim::eval {
namespace {

constexpr double kManySigmas = 3;
// Errors of a good run vary by a factor of three or four; ten is another place.
constexpr double kFarOff = 10;
// Both files have the times of the same keyframes.
constexpr double kSameTime_s = 1e-6;

/// Of sorted values, between neighbours by straight lines.
double quantile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return 0;
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<size_t>(at);
  const size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

Ratios summarise_ratios(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  Ratios out;
  out.count = values.size();
  if (values.empty()) return out;
  const auto beyond = values.end() - std::upper_bound(values.begin(), values.end(), kManySigmas);
  out.beyond_3 = static_cast<double>(beyond) / static_cast<double>(values.size());
  out.median = quantile(values, 0.5);
  out.p95 = quantile(values, 0.95);
  out.max = values.back();
  return out;
}

double ratio(double error, double sigma) {
  if (error == 0) return 0;
  return sigma > 0 ? error / sigma : std::numeric_limits<double>::max();
}

/// Keyframes of one segment and what is claimed of them.
struct Segment {
  Trajectory poses;
  std::vector<KeyframeClaim> claims;
};

std::map<int64_t, Segment> split(const Trajectory& estimate,
                                 const std::vector<KeyframeClaim>& claims) {
  std::map<int64_t, Segment> segments;
  for (const KeyframeClaim& claim : claims) {
    const auto found =
        std::lower_bound(estimate.poses.begin(), estimate.poses.end(), claim.time_s - kSameTime_s,
                         [](const Pose& pose, double time_s) { return pose.time_s < time_s; });
    if (found == estimate.poses.end() || found->time_s > claim.time_s + kSameTime_s) continue;
    Segment& segment = segments[claim.segment];
    segment.poses.format = estimate.format;
    segment.poses.name = estimate.name;
    segment.poses.poses.push_back(*found);
    segment.claims.push_back(claim);
  }
  return segments;
}

/// Ratios and errors of all segments.
struct Collected {
  std::vector<double> position, rotation;
  std::map<int64_t, std::vector<double>> by_confidence;
};

/// The rotation nearest to all of them together.
Eigen::Matrix3d mean_rotation(const std::vector<Eigen::Matrix3d>& rotations) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Eigen::Matrix3d& R : rotations) sum += R;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign = Eigen::Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) sign(2) = -1;
  return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
}

void add(const Trajectory& truth, const Segment& segment, double max_dt_s, Collected* all,
         Consistency* out) {
  const Ate ate = absolute_trajectory_error(truth, segment.poses, Alignment::kSim3, max_dt_s);
  const Similarity& T = ate.T_truth_estimate;
  std::vector<Eigen::Matrix3d> turns;  // of the camera from the true one
  for (const IndexPair& pair : ate.pairs) {
    turns.push_back(truth.poses[pair.ground_truth].R.transpose() * T.R *
                    segment.poses.poses[pair.estimate].R);
  }
  const Eigen::Matrix3d mean = mean_rotation(turns);
  for (size_t k = 0; k < ate.pairs.size(); ++k) {
    const KeyframeClaim& claim = segment.claims[ate.pairs[k].estimate];
    const double error = ate.distance[k];
    all->by_confidence[claim.confidence].push_back(error);
    out->good += claim.good ? 1 : 0;
    out->good_far_off += claim.good && error > kFarOff * ate.error.median ? 1 : 0;
    if (claim.position_sigma < 0 || claim.rotation_sigma < 0) {
      ++out->without_sigma;
      continue;
    }
    all->position.push_back(ratio(error, T.s * claim.position_sigma));
    if (T.roll_open) continue;
    const Eigen::AngleAxisd left(turns[k] * mean.transpose());
    all->rotation.push_back(ratio(left.angle(), claim.rotation_sigma));
  }
  ++out->segments;
}

}  // namespace

Consistency consistency(const Trajectory& truth, const Trajectory& estimate,
                        const std::vector<KeyframeClaim>& claims, double max_dt_s) {
  Consistency out;
  Collected all;
  const std::map<int64_t, Segment> segments = split(estimate, claims);
  for (const auto& [id, segment] : segments) {
    try {
      add(truth, segment, max_dt_s, &all, &out);
    } catch (const ScoreError&) {
      ++out.segments_skipped;
      if (out.segments == 0 && out.segments_skipped == segments.size()) throw;
    }
  }
  if (segments.empty()) {
    throw ScoreError(ScoreError::Kind::kFewPairs,
                     "no keyframe of the table has a pose in " + estimate.name);
  }
  for (auto& [confidence, errors] : all.by_confidence) {
    std::sort(errors.begin(), errors.end());
    out.by_confidence[confidence] = {errors.size(), quantile(errors, 0.5)};
  }
  out.position = summarise_ratios(std::move(all.position));
  out.rotation = summarise_ratios(std::move(all.rotation));
  return out;
}

}  // namespace unisim::eval
