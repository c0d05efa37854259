// SPDX-License-Identifier: MIT
// Building of scenes from rectangles, with the light baked into their textures.
#include "tools/synth/scene.hpp"

#include <array>

namespace unisim::synth {
namespace {

using Eigen::Vector3d;

constexpr double kAmbient = 0.5;

}  // namespace

double Scene::brightness(const Vector3d& point, const Vector3d& normal) const {
  double sum = kAmbient;
  for (const Light& light : lights_) {
    const Vector3d to_light = light.position - point;
    const double square = to_light.squaredNorm();
    const double cosine = std::max(0.0, normal.dot(to_light) / std::sqrt(square));
    // Wrapped cosine and softened distance: light that has also bounced off the other walls.
    sum += light.strength * (0.35 + 0.65 * cosine) / (1 + 0.35 * square);
  }
  return sum;
}

void Scene::add_face(const Vector3d& corner, const Vector3d& axis_u, const Vector3d& axis_v,
                     double width, double height, const Painter& painter) {
  Canvas canvas(width, height, texel_);
  painter(&canvas);
  const Vector3d normal = -axis_u.cross(axis_v);
  canvas.shade([&](double x, double y) {
    return static_cast<float>(brightness(corner + x * axis_u + y * axis_v, normal));
  });
  faces_.push_back({corner, axis_u, axis_v, width, height, Texture(canvas)});
}

void Scene::add_shell(const Vector3d& size, const std::vector<Painter>& painters) {
  const double x = size.x() / 2;
  const double y = size.y() / 2;
  const double z = size.z();
  const Vector3d east = Vector3d::UnitX();
  const Vector3d north = Vector3d::UnitY();
  const Vector3d down = -Vector3d::UnitZ();
  add_face({-x, y, z}, east, down, size.x(), z, painters[0]);
  add_face({x, y, z}, -north, down, size.y(), z, painters[1]);
  add_face({x, -y, z}, -east, down, size.x(), z, painters[2]);
  add_face({-x, -y, z}, north, down, size.y(), z, painters[3]);
  add_face({-x, y, 0}, east, -north, size.x(), size.y(), painters[4]);
  add_face({-x, -y, z}, east, north, size.x(), size.y(), painters[5]);
}

void Scene::add_box(const Vector3d& center, const Vector3d& size, double yaw_rad,
                    const std::function<void(Canvas*, int)>& painter) {
  const Eigen::AngleAxisd turn(yaw_rad, Vector3d::UnitZ());
  const Vector3d ex = turn * Vector3d::UnitX();
  const Vector3d ey = turn * Vector3d::UnitY();
  const Vector3d down = -Vector3d::UnitZ();
  const Vector3d top = center + Vector3d(0, 0, size.z());
  const Vector3d half_x = ex * (size.x() / 2);
  const Vector3d half_y = ey * (size.y() / 2);
  const auto add = [&](int number, const Vector3d& corner, const Vector3d& u, const Vector3d& v,
                       double width, double height) {
    add_face(corner, u, v, width, height, [&](Canvas* canvas) { painter(canvas, number); });
  };
  add(0, top - half_x - half_y, ex, down, size.x(), size.z());
  add(1, top + half_x - half_y, ey, down, size.y(), size.z());
  add(2, top + half_x + half_y, -ex, down, size.x(), size.z());
  add(3, top - half_x + half_y, -ey, down, size.y(), size.z());
  add(4, top - half_x + half_y, ex, -ey, size.x(), size.y());
  add(5, center - half_x - half_y, ex, ey, size.x(), size.y());
}

bool parse_scene_kind(const std::string& name, SceneKind* kind) {
  static constexpr std::array<const char*, 6> kNames = {"room",     "corridor",   "desk",
                                                        "rotation", "lowtexture", "static"};
  for (size_t i = 0; i < kNames.size(); ++i) {
    if (name == kNames[i]) {
      *kind = static_cast<SceneKind>(i);
      return true;
    }
  }
  return false;
}

Scene make_scene(SceneKind kind, uint64_t seed) {
  switch (kind) {
    case SceneKind::kCorridor:
      return make_corridor(seed);
    case SceneKind::kDesk:
      return make_desk(seed);
    case SceneKind::kLowTexture:
      return make_low_texture_room(seed);
    case SceneKind::kRoom:
    case SceneKind::kRotation:
    case SceneKind::kStatic:
      break;
  }
  return make_room(seed);
}

}  // namespace unisim::synth
