// SPDX-License-Identifier: MIT
// Simulated world: room and boxes by chance, depth by ray casting.
#include "tools/bench/simulator/world.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace unisim::simulator {
namespace {

using Eigen::Array3d;
using Eigen::Vector3d;

constexpr double kNearest = 0.15;                       // m, no surface is closer
constexpr double kFreeSpace = 0.25;                     // m between path and boxes
constexpr double kWallDistance = 0.5;                   // m between path and walls
constexpr double kTanHalfWidth = 0.57735026918962576;   // 60 degrees
constexpr double kTanHalfHeight = 0.42447481620960476;  // 46 degrees
constexpr int kBoxTrials = 400;

struct Box {
  Array3d low;
  Array3d high;
};

Box draw_box(const Array3d& half, NoiseSource* noise) {
  Array3d center;
  Array3d size;
  for (int d = 0; d < 3; ++d) {
    center[d] = noise->uniform(-half[d], d == 2 ? 0.2 : half[d]);
    size[d] = noise->uniform(0.15, 0.5);
  }
  return {center - size, center + size};
}

bool blocks_path(const Box& box, const std::vector<RigidPose>& path) {
  return std::any_of(path.begin(), path.end(), [&](const RigidPose& pose) {
    const Array3d p = pose.t.array();
    return (p > box.low - kFreeSpace).all() && (p < box.high + kFreeSpace).all();
  });
}

std::vector<Box> draw_boxes(WorldKind kind, const Array3d& half, const std::vector<RigidPose>& path,
                            NoiseSource* noise) {
  const size_t wanted = kind == WorldKind::kWalk ? 14 : 6;
  std::vector<Box> boxes;
  for (int trial = 0; trial < kBoxTrials && boxes.size() < wanted; ++trial) {
    const Box box = draw_box(half, noise);
    if (!blocks_path(box, path)) boxes.push_back(box);
  }
  return boxes;
}

// Walls half a metre from the path, or further: the path is pressed into the room.
void fit_into_room(const Array3d& half, std::vector<RigidPose>* path) {
  Vector3d mean = Vector3d::Zero();
  for (const RigidPose& pose : *path) mean += pose.t;
  mean /= static_cast<double>(path->size());
  Array3d reach = Array3d::Constant(1e-9);
  for (const RigidPose& pose : *path) reach = reach.max((pose.t - mean).array().abs());
  const Array3d scale = ((half - kWallDistance) / reach).min(1.0);
  for (RigidPose& pose : *path) pose.t = ((pose.t - mean).array() * scale).matrix();
}

// Length of a ray until a surface, in multiples of its direction.
double cast(const Array3d& origin, const Array3d& direction, const Array3d& half,
            const std::vector<Box>& boxes) {
  double nearest = ((-half - origin) / direction).max((half - origin) / direction).minCoeff();
  for (const Box& box : boxes) {
    const Array3d one = (box.low - origin) / direction;
    const Array3d other = (box.high - origin) / direction;
    const double in = one.min(other).maxCoeff();
    const double out = one.max(other).minCoeff();
    if (in < out && in > kNearest) nearest = std::min(nearest, in);
  }
  return std::max(nearest, kNearest);
}

DepthMap see(const RigidPose& pose, const Array3d& half, const std::vector<Box>& boxes) {
  DepthMap depth;
  for (int32_t pixel = 0; pixel < kDepthPixels; ++pixel) {
    const Eigen::Vector2d at = image_position(pixel);
    const Vector3d ray(at.x() * kTanHalfWidth, at.y() * kTanHalfHeight, 1.0);
    Array3d direction = (pose.R * ray).array();
    for (double& d : direction) d = std::abs(d) < 1e-9 ? 1e-9 : d;
    depth[static_cast<size_t>(pixel)] =
        static_cast<float>(cast(pose.t.array(), direction, half, boxes));
  }
  return depth;
}

}  // namespace

Eigen::Vector2d image_position(int32_t pixel) {
  return {2.0 * (pixel % kDepthWidth) / (kDepthWidth - 1) - 1.0,
          2.0 * (pixel / kDepthWidth) / (kDepthHeight - 1) - 1.0};
}

World make_world(WorldKind kind, int32_t keyframes, uint64_t seed) {
  NoiseSource noise(synth::derive_seed(seed, 0));
  World world;
  world.T_world_kf = camera_path(kind, keyframes, &noise);
  Array3d half(6.5, 4.5, 1.3);
  if (kind != WorldKind::kWalk) {
    half[0] = noise.uniform(2.0, 3.0);
    half[1] = noise.uniform(1.7, 2.6);
    fit_into_room(half, &world.T_world_kf);
  }
  const std::vector<Box> boxes = draw_boxes(kind, half, world.T_world_kf, &noise);
  for (const RigidPose& pose : world.T_world_kf) {
    world.depth.push_back(see(pose, half, boxes));
    const DepthMap& depth = world.depth.back();
    world.mean_depth.push_back(std::accumulate(depth.begin(), depth.end(), 0.0) / kDepthPixels);
  }
  return world;
}

}  // namespace unisim::simulator
