// SPDX-License-Identifier: MIT
// The world seen from above.
#include "tools/live/web/top_view.hpp"

#include <cmath>

#include "drivers/pipeline/similarity.hpp"

namespace unisim::live::web {
namespace {

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// `vector` made level and of length 1. @return false where it has no level part to speak of
bool level(const Vector& down, Vector* vector) {
  const double along = dot(*vector, down);
  for (size_t k = 0; k < 3; ++k) (*vector)[k] -= along * down[k];
  const double length = std::sqrt(dot(*vector, *vector));
  if (!(length > 0.1)) return false;
  for (double& value : *vector) value /= length;
  return true;
}

}  // namespace

Vector transform(const unisim_sim3& T_world_cam, const Vector& point) {
  const unisim_sim3 moved =
      pipeline::compose(T_world_cam, {{0.0, 0.0, 0.0, 1.0}, {point[0], point[1], point[2]}, 1.0});
  return {moved.t[0], moved.t[1], moved.t[2]};
}

void TopView::fit(const std::vector<PathPoint>& path, int32_t segment) {
  Vector sum{};
  for (const PathPoint& point : path) {
    if (point.segment != segment) continue;
    unisim_sim3 rotation = point.T_world_cam;
    for (double& value : rotation.t) value = 0.0;
    rotation.s = 1.0;
    const Vector down = transform(rotation, {0.0, 1.0, 0.0});
    for (size_t k = 0; k < 3; ++k) sum[k] += down[k];
  }
  const double length = std::sqrt(dot(sum, sum));
  // Cameras that look every way up cancel out: what was is kept.
  if (!(length > 1e-3)) return;
  Vector down = sum;
  for (double& value : down) value /= length;
  Vector right = {1.0, 0.0, 0.0};
  if (!level(down, &right)) {
    right = {0.0, 0.0, 1.0};
    level(down, &right);
  }
  down_ = down;
  right_ = right;
  ahead_ = cross(right, down);
}

TopView::Place TopView::place(const Vector& world) const {
  return {dot(world, right_), dot(world, ahead_), -dot(world, down_)};
}

}  // namespace unisim::live::web
