// SPDX-License-Identifier: MIT
// Images of a textured room from a moving camera, with exact poses.
#include "tests/geometric/rendered_room.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace unisim::geometric::test {

namespace {

const Eigen::Vector3d kHalfRoom(3.0, 2.0, 3.0);

double lattice(int wall, int u, int v) {
  std::uint32_t h = static_cast<std::uint32_t>(u) * 73856093U ^
                    static_cast<std::uint32_t>(v) * 19349663U ^
                    static_cast<std::uint32_t>(wall) * 83492791U;
  h ^= h >> 13;
  h *= 0x5bd1e995U;
  h ^= h >> 15;
  h *= 0x27d4eb2dU;
  h ^= h >> 16;
  return static_cast<double>(h & 0xffffU) / 65535.0;
}

double noise(int wall, double u, double v) {
  const double fu = std::floor(u);
  const double fv = std::floor(v);
  const int iu = static_cast<int>(fu);
  const int iv = static_cast<int>(fv);
  const double a = (u - fu) * (u - fu) * (3 - 2 * (u - fu));
  const double b = (v - fv) * (v - fv) * (3 - 2 * (v - fv));
  const double top = lattice(wall, iu, iv) * (1 - a) + lattice(wall, iu + 1, iv) * a;
  const double bottom = lattice(wall, iu, iv + 1) * (1 - a) + lattice(wall, iu + 1, iv + 1) * a;
  return top * (1 - b) + bottom * b;
}

double wall_gray(const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) {
  double nearest = std::numeric_limits<double>::infinity();
  int axis = 0;
  for (int k = 0; k < 3; ++k) {
    if (std::abs(ray[k]) < 1e-12) continue;
    const double distance = ((ray[k] > 0 ? kHalfRoom[k] : -kHalfRoom[k]) - origin[k]) / ray[k];
    if (distance >= nearest) continue;
    nearest = distance;
    axis = k;
  }
  const Eigen::Vector3d hit = origin + nearest * ray;
  const int wall = 2 * axis + (ray[axis] > 0 ? 1 : 0);
  const double u = hit[(axis + 1) % 3];
  const double v = hit[(axis + 2) % 3];
  return 255.0 * (0.6 * noise(wall, 7 * u, 7 * v) + 0.4 * noise(wall + 8, 17 * u, 17 * v));
}

}  // namespace

GrayImage render_room(const CameraPlace& place, double focal) {
  GrayImage image;
  image.reserve(static_cast<std::size_t>(kWidth) * kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const Eigen::Vector3d ray((x - (kWidth / 2.0 - 0.5)) / focal,
                                (y - (kHeight / 2.0 - 0.5)) / focal, 1.0);
      const double gray = wall_gray(place.center, place.R * ray);
      image.push_back(static_cast<std::uint8_t>(std::clamp(gray, 0.0, 255.0)));
    }
  }
  return image;
}

CameraPlace walk(int step) {
  CameraPlace place;
  const double t = 0.025 * step;
  place.center = Eigen::Vector3d(std::sin(t) * 1.2 - 0.6, 0.3 * std::sin(1.7 * t), -1.0 + 0.5 * t);
  const Eigen::Vector3d up(0.1 * std::sin(0.9 * t), 0.35 * std::sin(1.3 * t), 0.05 * t);
  place.R = Eigen::AngleAxisd(up.norm(), up.normalized()).toRotationMatrix();
  if (step == 0) place.R.setIdentity();
  return place;
}

CameraPlace turn(int step) {
  CameraPlace place;
  place.R = Eigen::AngleAxisd(0.012 * step, Eigen::Vector3d(0.1, 1.0, 0.05).normalized())
                .toRotationMatrix();
  return place;
}

}  // namespace unisim::geometric::test
