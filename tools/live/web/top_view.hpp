// SPDX-License-Identifier: MIT
// The world seen from above, as far as a camera alone knows where that is.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tools/live/web/view.hpp"

namespace unisim::live::web {

/// Down is the mean of the cameras' own down: they are held or mounted upright more often than not.
/// Across and up on the page are the first camera's right and forward, made level.
class TopView {
 public:
  /// @param segment whose poses count
  void fit(const std::vector<PathPoint>& path, int32_t segment);

  struct Place {
    double across = 0.0;
    double ahead = 0.0;
    double height = 0.0;  ///< upwards
  };
  Place place(const std::array<double, 3>& world) const;

 private:
  std::array<double, 3> right_{1.0, 0.0, 0.0};
  std::array<double, 3> down_{0.0, 1.0, 0.0};
  std::array<double, 3> ahead_{0.0, 0.0, 1.0};
};

/// A point of the camera's frame in the world.
std::array<double, 3> transform(const unisim_sim3& T_world_cam, const std::array<double, 3>& point);

}  // namespace unisim::live::web
