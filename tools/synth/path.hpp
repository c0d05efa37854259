// SPDX-License-Identifier: MIT
// Where the camera is: a smooth round through the scene, carried by an unsteady hand.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "tools/synth/scene.hpp"

namespace unisim::synth {

/// Sum of sines of random frequency and phase, smooth at every order.
class Sway {
 public:
  /// @param amplitude  of the slowest sine; faster ones are smaller in proportion to their period
  Sway(double amplitude, uint64_t seed);

  double at(double time_s) const;

 private:
  struct Sine {
    double amplitude;
    double frequency_rad;
    double phase;
  };
  std::array<Sine, 5> sines_;
};

struct PathOptions {
  SceneKind scene = SceneKind::kRoom;
  double duration_s = 10;
  int loops = 1;  ///< rounds; 0: an open path that comes back to no place
  uint64_t seed = 1;
};

class CameraPath {
 public:
  explicit CameraPath(const PathOptions& options);

  /// Camera-to-world pose at 0 <= time_s <= duration_s, and a little outside.
  Eigen::Isometry3d T_world_cam(double time_s) const;

 private:
  struct View {
    Eigen::Vector3d eye;
    Eigen::Vector3d target;
  };

  double progress(double time_s) const;
  View steady_view(double progress) const;
  View orbit_room(double rounds) const;
  View walk_corridor(double progress) const;
  View swing_at_desk(double progress) const;

  PathOptions options_;
  double start_;
  std::array<Sway, 3> position_sway_;
  std::array<Sway, 3> rotation_sway_;
};

}  // namespace unisim::synth
