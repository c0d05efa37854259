// SPDX-License-Identifier: MIT
// Depth between sparse measured pixels: planes fitted to what lies around.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "unisim/unisim.h"

namespace unisim::replay {

/// Fills a depth map of which only pixels of high confidence are measured.
///
/// A plane has an inverse depth that is affine in the image, so each pixel gets the value of a
/// local fit to the inverse depths measured around it, near ones and those of like colour counting
/// most, those of another surface little. Its confidence, of at most kFitted, sinks with what the
/// neighbours disagree about the surface, and where they lie on one side only.
class SurfaceFit {
 public:
  using Rgb = std::array<uint8_t, 3>;

  static constexpr float kFitted = 0.5F;  ///< confidence of a pixel well inside of its neighbours

  /// @param map     confidence not NULL
  /// @param sure    pixels of at least this confidence are measured; they are kept as they are
  /// @param colours of the pixels, in rows; empty: colours count for nothing
  /// @return the map filled; its data live in this object until the next call. Pixels without
  ///         enough around them have depth 0
  const unisim_depth_map& fill(const unisim_depth_map& map, float sure,
                               const std::vector<Rgb>& colours);

 private:
  struct Sample {
    float column;
    float row;
    float inverse_depth;
    std::array<float, 3> colour;
  };

  struct Neighbour {
    float dx;  // from the pixel
    float dy;
    float inverse_depth;
    float weight;  // by nearness and colour
    float robust;  // times what its residual leaves of it
  };
  struct Plane;

  void gather(const unisim_depth_map& map, float sure, const std::vector<Rgb>& colours);
  void near(int column, int row, const Rgb* colour);
  bool fit(float* inverse_depth, float* confidence);
  static bool plane_through(const std::vector<Neighbour>& neighbours, Plane* plane);

  std::vector<Sample> samples_;
  std::vector<int32_t> sample_at_;  // by pixel: 1 + sample, 0: none
  std::vector<Neighbour> neighbours_;
  std::vector<float> depth_;
  std::vector<float> confidence_;
  unisim_depth_map filled_{};
};

}  // namespace unisim::replay
