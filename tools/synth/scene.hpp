// SPDX-License-Identifier: MIT
// A scene of flat painted rectangles. World frame: metres, z up.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tools/synth/texture.hpp"

namespace unisim::synth {

/// A rectangle seen from the side against which axis_u x axis_v points: from there u runs right and
/// v runs down.
struct Face {
  Eigen::Vector3d corner;  ///< where u = v = 0
  Eigen::Vector3d axis_u;  ///< unit
  Eigen::Vector3d axis_v;  ///< unit, perpendicular to axis_u
  double width = 0;        ///< along u
  double height = 0;       ///< along v
  Texture texture;
};

struct Light {
  Eigen::Vector3d position;
  double strength = 1;
};

/// Paints one face; u and v of the canvas are those of the face.
using Painter = std::function<void(Canvas*)>;

class Scene {
 public:
  /// @param texel  metres per texel of everything added after
  explicit Scene(double texel) : texel_(texel) {}

  void add_light(const Light& light) { lights_.push_back(light); }

  /// Paint and light one rectangle. The lights must be there already.
  void add_face(const Eigen::Vector3d& corner, const Eigen::Vector3d& axis_u,
                const Eigen::Vector3d& axis_v, double width, double height, const Painter& painter);

  /// Walls of an empty box seen from inside, centred on the origin, standing on z = 0.
  /// @param painters  walls at +y, +x, -y, -x, then floor and ceiling
  void add_shell(const Eigen::Vector3d& size, const std::vector<Painter>& painters);

  /// Box seen from outside, all faces painted by painter(canvas, face number).
  /// @param center  middle of its bottom
  /// @param yaw_rad  turn about z
  void add_box(const Eigen::Vector3d& center, const Eigen::Vector3d& size, double yaw_rad,
               const std::function<void(Canvas*, int)>& painter);

  const std::vector<Face>& faces() const { return faces_; }

 private:
  double brightness(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const;

  double texel_;
  std::vector<Light> lights_;
  std::vector<Face> faces_;
};

enum class SceneKind { kRoom, kCorridor, kDesk, kRotation, kLowTexture, kStatic };

/// @return false when `name` is none of room, corridor, desk, rotation, lowtexture, static
bool parse_scene_kind(const std::string& name, SceneKind* kind);

Scene make_room(uint64_t seed);
Scene make_low_texture_room(uint64_t seed);
Scene make_corridor(uint64_t seed);
Scene make_desk(uint64_t seed);
Scene make_scene(SceneKind kind, uint64_t seed);

/// Inner size of the places, metres.
inline const Eigen::Vector3d kRoomSize(5.0, 4.0, 2.8);
inline const Eigen::Vector3d kCorridorSize(24.0, 2.4, 2.6);
inline const Eigen::Vector3d kDeskRoomSize(3.6, 3.2, 2.6);
/// Where the desk top stands in its room.
inline const Eigen::Vector3d kDeskCenter(0.0, 0.9, 0.75);

}  // namespace unisim::synth
