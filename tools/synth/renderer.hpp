// SPDX-License-Identifier: MIT
// Ray casting of a scene of rectangles, with smoothed edges and exact depth.
//
// On a plane, 1/z is affine in the ray's x and y and so are the numerators of its surface
// coordinates; a ray costs a few multiplications per rectangle that its tile can see.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <vector>

#include "tools/synth/camera.hpp"
#include "tools/synth/scene.hpp"

namespace unisim::synth {

/// Linear sum of rendered frames, RGB, row-major.
using ColorImage = std::vector<Color>;
/// z-depth in metres at pixel centres, row-major; 0 where nothing is seen.
using DepthImage = std::vector<float>;

class Renderer {
 public:
  /// @param scene    must outlive the renderer
  /// @param rolling  rows have poses of their own
  Renderer(const Scene& scene, const Camera& camera, bool rolling);

  /// Add the view from T_world_cam to `colors`. @param depth  NULL when not wanted
  /// @param T_world_cam  of a row; asked once, for the first, where the shutter does not roll
  void render(const std::function<Eigen::Isometry3d(int)>& T_world_cam, ColorImage* colors,
              DepthImage* depth) const;

 private:
  /// A face as seen from one pose; see the file's head.
  struct Plane {
    Eigen::Vector3f inverse_depth;  ///< times (x, y, 1) gives 1/z
    Eigen::Vector3f axis_u;
    Eigen::Vector3f axis_v;
    float offset_u = 0;
    float offset_v = 0;
    float width = 0;
    float height = 0;
    Eigen::Matrix<double, 3, 4> corners;  ///< in the camera frame
    const Texture* texture = nullptr;
  };
  struct Hit {
    const Plane* plane = nullptr;
    float inverse_depth = 0;
    float u = 0;
    float v = 0;
  };
  /// First and last pixel of a tile, last not included, and the inner sides of its frustum.
  struct Tile {
    int left = 0;
    int top = 0;
    int right = 0;
    int bottom = 0;
    Eigen::Matrix<double, 5, 3> sides;
  };
  using Planes = std::vector<Plane>;
  using Candidates = std::vector<const Plane*>;

  Planes place(const Eigen::Isometry3d& T_world_cam) const;
  Tile make_tile(int left, int top, int rows) const;
  static void find_candidates(const Planes& planes, const Tile& tile, Candidates* candidates);
  void render_tile(const Tile& tile, const Candidates& candidates, ColorImage* colors,
                   DepthImage* depth) const;
  static Hit nearest(const Candidates& candidates, const Eigen::Vector2f& ray);
  static Color shade(const Hit& hit, float pixel);
  Color shade_edge(const Candidates& candidates, int column, int row) const;
  const Eigen::Vector2f& corner_ray(int column, int row) const {
    return corner_rays_[static_cast<size_t>(row) * static_cast<size_t>(camera_.width + 1) +
                        static_cast<size_t>(column)];
  }

  const Scene& scene_;
  Camera camera_;
  bool rolling_;
  std::vector<Eigen::Vector2f> center_rays_;
  std::vector<Eigen::Vector2f> corner_rays_;
  std::vector<Tile> tiles_;
};

}  // namespace unisim::synth
