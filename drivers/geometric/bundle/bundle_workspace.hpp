// SPDX-License-Identifier: MIT
// Memory of a BundleAdjuster beside its linear system: the last accepted state and lists for
// medians.
#pragma once

#include <vector>

#include "drivers/geometric/bundle/bundle_adjuster.hpp"
#include "drivers/geometric/bundle/tile_cholesky.hpp"

namespace unisim::geometric {

struct BundleAdjuster::Workspace {
  std::vector<CameraPose> poses;
  std::vector<Eigen::Vector3d> positions;
  BundleIntrinsics intrinsics;
  std::vector<double> norms;
  std::vector<double> depths;
  std::vector<double> solution;

  explicit Workspace(const BundleCapacity& capacity)
      : poses(static_cast<std::size_t>(capacity.cameras)),
        positions(static_cast<std::size_t>(capacity.points)),
        solution(static_cast<std::size_t>(TileCholesky::kBlock * (capacity.free_cameras + 1) +
                                          TileCholesky::kTile)) {
    norms.reserve(static_cast<std::size_t>(capacity.observations));
    depths.reserve(static_cast<std::size_t>(capacity.observations));
  }

  void save(const BundleProblem& problem) {
    for (int i = 0; i < problem.camera_count(); ++i) {
      poses[static_cast<std::size_t>(i)] = problem.camera(i).pose;
    }
    for (int i = 0; i < problem.point_count(); ++i) {
      positions[static_cast<std::size_t>(i)] = problem.point(i).position;
    }
    intrinsics = problem.intrinsics;
  }

  void restore(BundleProblem* problem) const {
    for (int i = 0; i < problem->camera_count(); ++i) {
      problem->camera(i).pose = poses[static_cast<std::size_t>(i)];
    }
    for (int i = 0; i < problem->point_count(); ++i) {
      problem->point(i).position = positions[static_cast<std::size_t>(i)];
    }
    problem->intrinsics = intrinsics;
  }

  std::size_t memory_bytes() const {
    return poses.capacity() * sizeof(CameraPose) + positions.capacity() * sizeof(Eigen::Vector3d) +
           (norms.capacity() + depths.capacity() + solution.capacity()) * sizeof(double);
  }
};

}  // namespace unisim::geometric
