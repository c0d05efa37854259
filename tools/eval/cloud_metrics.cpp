// SPDX-License-Identifier: MIT
// How near a reconstructed cloud is to the true one.
#include "tools/eval/cloud_metrics.hpp"

#include <algorithm>
#include <opencv2/flann.hpp>

#include "tools/eval/trajectory.hpp"

namespace unisim::eval {
namespace {

using Points = std::vector<Eigen::Vector3d>;

// The index works in float: coordinates are taken from a point in the middle of things.
cv::Mat1f float_coordinates(const Points& points, const Eigen::Vector3d& origin) {
  cv::Mat1f rows(static_cast<int>(points.size()), 3);
  for (size_t k = 0; k < points.size(); ++k) {
    for (int i = 0; i < 3; ++i) {
      rows(static_cast<int>(k), i) = static_cast<float>(points[k](i) - origin(i));
    }
  }
  return rows;
}

// Exact nearest neighbours by a k-d tree, O(n log m); distances in double.
std::vector<double> nearest_distances(const Points& from, const Points& to) {
  cv::Mat1f indexed = float_coordinates(to, to.front());
  cv::Mat1f queries = float_coordinates(from, to.front());
  cv::flann::GenericIndex<cvflann::L2_Simple<float>> index(indexed,
                                                           cvflann::KDTreeSingleIndexParams(16));
  cv::Mat1i neighbours(queries.rows, 1);
  cv::Mat1f squared(queries.rows, 1);
  index.knnSearch(queries, neighbours, squared, 1, cvflann::SearchParams(-1, 0.0F, true));
  std::vector<double> distances(from.size());
  for (size_t k = 0; k < from.size(); ++k) {
    const auto neighbour = static_cast<size_t>(neighbours(static_cast<int>(k), 0));
    distances[k] = (from[k] - to[neighbour]).norm();
  }
  return distances;
}

size_t cut(std::vector<double>* distances, double max_distance) {
  size_t beyond = 0;
  for (double& d : *distances) {
    if (max_distance <= 0 || d <= max_distance) continue;
    d = max_distance;
    ++beyond;
  }
  return beyond;
}

}  // namespace

CloudMetrics compare_clouds(const Cloud& ground_truth, const Cloud& estimate,
                            const Similarity& T_truth_estimate, double max_distance) {
  Points moved;
  moved.reserve(estimate.points.size());
  for (const Eigen::Vector3d& p : estimate.points) {
    moved.push_back(T_truth_estimate * p);
    if (!is_near(moved.back()))
      throw InputError(estimate.name + ": moved as the trajectories align, it is out of range");
  }
  std::vector<double> to_truth = nearest_distances(moved, ground_truth.points);
  std::vector<double> to_estimate = nearest_distances(ground_truth.points, moved);
  CloudMetrics metrics;
  metrics.beyond = cut(&to_truth, max_distance) + cut(&to_estimate, max_distance);
  metrics.accuracy = summarise(std::move(to_truth));
  metrics.completeness = summarise(std::move(to_estimate));
  metrics.chamfer = 0.5 * (metrics.accuracy.rmse + metrics.completeness.rmse);
  return metrics;
}

}  // namespace unisim::eval
