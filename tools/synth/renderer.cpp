// SPDX-License-Identifier: MIT
// Ray caster.
#include "tools/synth/renderer.hpp"

#include <array>

namespace unisim::synth {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr int kTileSize = 16;
constexpr double kNearest = 0.05;
/// Rays per pixel side where a pixel sees more than one face.
constexpr int kEdgeRays = 4;

}  // namespace

Renderer::Renderer(const Scene& scene, const Camera& camera, bool rolling)
    : scene_(scene), camera_(camera), rolling_(rolling) {
  for (int row = 0; row < camera.height; ++row) {
    for (int column = 0; column < camera.width; ++column) {
      center_rays_.push_back(camera.ray(column, row));
    }
  }
  for (int row = 0; row <= camera.height; ++row) {
    for (int column = 0; column <= camera.width; ++column) {
      corner_rays_.push_back(camera.ray(column - 0.5, row - 0.5));
    }
  }
  const int rows = rolling ? 1 : kTileSize;
  for (int top = 0; top < camera.height; top += rows) {
    for (int left = 0; left < camera.width; left += kTileSize) {
      tiles_.push_back(make_tile(left, top, rows));
    }
  }
}

Renderer::Planes Renderer::place(const Eigen::Isometry3d& T_world_cam) const {
  const Eigen::Isometry3d T_cam_world = T_world_cam.inverse(Eigen::Isometry);
  Planes planes;
  planes.reserve(scene_.faces().size());
  for (const Face& face : scene_.faces()) {
    const Vector3d corner = T_cam_world * face.corner;
    const Vector3d u = T_cam_world.linear() * face.axis_u;
    const Vector3d v = T_cam_world.linear() * face.axis_v;
    const Vector3d normal = u.cross(v);
    const double distance = normal.dot(corner);
    if (distance <= 1e-6) {
      continue;  // seen from behind
    }
    Plane plane;
    plane.inverse_depth = (normal / distance).cast<float>();
    plane.axis_u = u.cast<float>();
    plane.axis_v = v.cast<float>();
    plane.offset_u = static_cast<float>(u.dot(corner));
    plane.offset_v = static_cast<float>(v.dot(corner));
    plane.width = static_cast<float>(face.width);
    plane.height = static_cast<float>(face.height);
    plane.corners << corner, corner + face.width * u, corner + face.height * v,
        corner + face.width * u + face.height * v;
    plane.texture = &face.texture;
    planes.push_back(plane);
  }
  return planes;
}

Renderer::Tile Renderer::make_tile(int left, int top, int rows) const {
  Tile tile;
  tile.left = left;
  tile.top = top;
  tile.right = std::min(left + kTileSize, camera_.width);
  tile.bottom = std::min(top + rows, camera_.height);
  Vector2f low = corner_ray(left, top);
  Vector2f high = low;
  for (int row = top; row <= tile.bottom; ++row) {
    for (int column = left; column <= tile.right; ++column) {
      low = low.cwiseMin(corner_ray(column, row));
      high = high.cwiseMax(corner_ray(column, row));
    }
  }
  tile.sides << 1, 0, -low.x(), -1, 0, high.x(), 0, 1, -low.y(), 0, -1, high.y(), 0, 0, 1;
  return tile;
}

void Renderer::find_candidates(const Planes& planes, const Tile& tile, Candidates* candidates) {
  // A face wholly outside one side of the frustum, or nearer than any, is out.
  candidates->clear();
  for (const Plane& plane : planes) {
    const Eigen::Matrix<double, 5, 4> inside = tile.sides * plane.corners;
    const bool outside = (inside.topRows<4>().rowwise().maxCoeff().array() < 0).any() ||
                         inside.row(4).maxCoeff() < kNearest;
    if (!outside) {
      candidates->push_back(&plane);
    }
  }
}

Renderer::Hit Renderer::nearest(const Candidates& candidates, const Vector2f& ray) {
  const Vector3f direction(ray.x(), ray.y(), 1);
  Hit best;
  for (const Plane* plane : candidates) {
    const float inverse_depth = plane->inverse_depth.dot(direction);
    if (inverse_depth <= best.inverse_depth) {
      continue;
    }
    const float depth = 1 / inverse_depth;
    const float u = plane->axis_u.dot(direction) * depth - plane->offset_u;
    const float v = plane->axis_v.dot(direction) * depth - plane->offset_v;
    if (u >= 0 && u <= plane->width && v >= 0 && v <= plane->height) {
      best = {plane, inverse_depth, u, v};
    }
  }
  return best;
}

Color Renderer::shade(const Hit& hit, float pixel) {
  if (hit.plane == nullptr) {
    return Color::Zero();
  }
  const Plane& plane = *hit.plane;
  // Change of u = (axis_u . d) / (inverse_depth . d) - offset with x and y of the ray d.
  const float depth = pixel / hit.inverse_depth;
  const Vector2f du =
      depth * (plane.axis_u.head<2>() - (hit.u + plane.offset_u) * plane.inverse_depth.head<2>());
  const Vector2f dv =
      depth * (plane.axis_v.head<2>() - (hit.v + plane.offset_v) * plane.inverse_depth.head<2>());
  const Footprint footprint{hit.u / plane.width,   hit.v / plane.height, du.x() / plane.width,
                            dv.x() / plane.height, du.y() / plane.width, dv.y() / plane.height};
  return plane.texture->sample(footprint);
}

Color Renderer::shade_edge(const Candidates& candidates, int column, int row) const {
  const Vector2f& origin = corner_ray(column, row);
  const Vector2f across = (corner_ray(column + 1, row) - origin) / kEdgeRays;
  const Vector2f down = (corner_ray(column, row + 1) - origin) / kEdgeRays;
  const float pixel = 1 / static_cast<float>(camera_.focal_px);
  Color sum = Color::Zero();
  for (int i = 0; i < kEdgeRays; ++i) {
    for (int j = 0; j < kEdgeRays; ++j) {
      const Vector2f ray =
          origin + (static_cast<float>(j) + 0.5f) * across + (static_cast<float>(i) + 0.5f) * down;
      sum += shade(nearest(candidates, ray), pixel / kEdgeRays);
    }
  }
  return sum / (kEdgeRays * kEdgeRays);
}

void Renderer::render_tile(const Tile& tile, const Candidates& candidates, ColorImage* colors,
                           DepthImage* depth) const {
  const float pixel = 1 / static_cast<float>(camera_.focal_px);
  const int columns = tile.right - tile.left + 1;
  std::array<const Plane*, (kTileSize + 1) * (kTileSize + 1)> at_corner{};
  const bool may_have_edges = candidates.size() > 1;
  if (may_have_edges) {
    for (int row = tile.top; row <= tile.bottom; ++row) {
      for (int column = tile.left; column <= tile.right; ++column) {
        at_corner[static_cast<size_t>((row - tile.top) * columns + column - tile.left)] =
            nearest(candidates, corner_ray(column, row)).plane;
      }
    }
  }
  for (int row = tile.top; row < tile.bottom; ++row) {
    for (int column = tile.left; column < tile.right; ++column) {
      const size_t at = static_cast<size_t>(row) * static_cast<size_t>(camera_.width) +
                        static_cast<size_t>(column);
      const Hit hit = nearest(candidates, center_rays_[at]);
      const auto corner = static_cast<size_t>((row - tile.top) * columns + column - tile.left);
      const auto next_row = corner + static_cast<size_t>(columns);
      const bool edge = may_have_edges &&
                        (at_corner[corner] != hit.plane || at_corner[corner + 1] != hit.plane ||
                         at_corner[next_row] != hit.plane || at_corner[next_row + 1] != hit.plane);
      (*colors)[at] += edge ? shade_edge(candidates, column, row) : shade(hit, pixel);
      if (depth != nullptr) {
        (*depth)[at] = hit.plane == nullptr ? 0 : 1 / hit.inverse_depth;
      }
    }
  }
}

void Renderer::render(const std::function<Eigen::Isometry3d(int)>& T_world_cam, ColorImage* colors,
                      DepthImage* depth) const {
  Planes planes;
  Candidates candidates;
  for (const Tile& tile : tiles_) {
    const bool first = tile.top == 0 && tile.left == 0;
    if (first || (rolling_ && tile.left == 0)) planes = place(T_world_cam(tile.top));
    find_candidates(planes, tile, &candidates);
    render_tile(tile, candidates, colors, depth);
  }
}

}  // namespace unisim::synth
