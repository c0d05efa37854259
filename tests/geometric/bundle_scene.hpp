// SPDX-License-Identifier: MIT
// A made-up scene for the tests of the bundle folder: cameras on an arc that look at scattered
// points.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "drivers/geometric/bundle/bundle_problem.hpp"

namespace bundle_scene {

using unisim::geometric::BundleCapacity;
using unisim::geometric::BundleProblem;
using unisim::geometric::CameraModel;
using unisim::geometric::CameraPose;

struct Options {
  int cameras = 16;
  int points = 300;  ///< each seen by three cameras or more
  double noise_px = 0.0;
  double outlier_share = 0.0;  ///< observations thrown up to 60 px off
  double focal_px = 525.0;
  double k1 = -0.03;
  unsigned seed = 1;
  bool slides_along_wall = false;  ///< no turn, straight path, all points in one plane ahead
};

struct Observation {
  int camera = 0;
  int point = 0;
  Eigen::Vector2d pixel;
};

struct Scene {
  CameraModel model;
  std::vector<CameraPose> poses;
  std::vector<Eigen::Vector3d> points;
  std::vector<Observation> observations;  ///< by point, cameras ascending
};

/// Uniform in [-1, 1), the same on every standard library.
inline double uniform(std::mt19937* random) {
  return static_cast<double>((*random)()) / 2147483648.0 - 1.0;
}

/// About unit normal: sum of twelve uniforms.
inline double normal(std::mt19937* random) {
  double sum = 0.0;
  for (int i = 0; i < 12; ++i) sum += 0.5 * uniform(random);
  return sum;
}

inline Eigen::Vector3d uniform3(std::mt19937* random) {
  const double x = uniform(random);
  const double y = uniform(random);
  return Eigen::Vector3d(x, y, uniform(random));
}

inline Scene make(const Options& options) {
  std::mt19937 random(options.seed);
  Scene scene;
  scene.model.focal_px = options.focal_px;
  scene.model.k1 = options.k1;
  scene.model.cx = 319.5;
  scene.model.cy = 239.5;
  for (int i = 0; i < options.cameras; ++i) {
    const double a = 0.05 * i;
    CameraPose pose;
    pose.R = unisim::geometric::rotation_exp(
        Eigen::Vector3d(0.05 * std::sin(3 * a), -0.5 * a, 0.1 * std::sin(2 * a)));
    Eigen::Vector3d center(0.9 * a, 0.15 * std::sin(4 * a), 0.2 * a * a);
    if (options.slides_along_wall) {
      pose.R.setIdentity();
      center = Eigen::Vector3d(0.9 * a, 0.3 * a, 0.0);
    }
    pose.t = -(pose.R * center);
    scene.poses.push_back(pose);
  }
  while (static_cast<int>(scene.points.size()) < options.points) {
    const Eigen::Vector3d r = uniform3(&random);
    const double depth = options.slides_along_wall ? 2.2 : 2.2 + 0.8 * r.z();
    const Eigen::Vector3d point(0.3 + 1.6 * r.x(), 1.0 * r.y(), depth);
    const std::size_t before = scene.observations.size();
    for (int c = 0; c < options.cameras; ++c) {
      Eigen::Vector2d pixel;
      if (!scene.model.project(scene.poses[static_cast<std::size_t>(c)].apply(point), &pixel)) {
        continue;
      }
      pixel += options.noise_px * Eigen::Vector2d(normal(&random), normal(&random));
      if (0.5 * (uniform(&random) + 1.0) < options.outlier_share) {
        pixel += 60.0 * Eigen::Vector2d(uniform(&random), uniform(&random));
      }
      const bool inside =
          pixel.x() > 0.0 && pixel.x() < 639.0 && pixel.y() > 0.0 && pixel.y() < 479.0;
      const int index = static_cast<int>(scene.points.size());
      if (inside) scene.observations.push_back({c, index, pixel});
    }
    if (scene.observations.size() - before < 3) {
      scene.observations.resize(before);
    } else {
      scene.points.push_back(point);
    }
  }
  return scene;
}

inline BundleCapacity capacity(const Scene& scene) {
  BundleCapacity capacity;
  capacity.cameras = static_cast<int>(scene.poses.size());
  capacity.free_cameras = capacity.cameras;
  capacity.points = static_cast<int>(scene.points.size());
  capacity.observations = static_cast<int>(scene.observations.size());
  return capacity;
}

/// The true state of the scene as a problem; the first `fixed` cameras are held.
inline void fill(const Scene& scene, int fixed, BundleProblem* problem) {
  problem->clear();
  problem->intrinsics.set_model(scene.model);
  for (std::size_t i = 0; i < scene.poses.size(); ++i) {
    problem->add_camera(scene.poses[i], static_cast<int>(i) < fixed);
  }
  std::size_t o = 0;
  for (std::size_t p = 0; p < scene.points.size(); ++p) {
    problem->add_point(scene.points[p]);
    for (; o < scene.observations.size() && scene.observations[o].point == static_cast<int>(p);
         ++o) {
      const Observation& seen = scene.observations[o];
      problem->add_observation(seen.camera, seen.pixel.x(), seen.pixel.y(), 1.0);
    }
  }
}

/// Moves free cameras, points and free intrinsics off by about the sizes given.
inline void perturb(double rotation_rad, double translation, double point, unsigned seed,
                    BundleProblem* problem) {
  std::mt19937 random(seed);
  for (int i = 0; i < problem->camera_count(); ++i) {
    Eigen::Matrix<double, 6, 1> step;
    step.head<3>() = translation * uniform3(&random);
    step.tail<3>() = rotation_rad * uniform3(&random);
    if (problem->camera(i).fixed) continue;
    problem->camera(i).pose = unisim::geometric::retract(problem->camera(i).pose, step);
  }
  for (int p = 0; p < problem->point_count(); ++p) {
    problem->point(p).position += point * uniform3(&random);
  }
}

}  // namespace bundle_scene
