// SPDX-License-Identifier: MIT
// Gives positions to the tracks of the newest keyframe: triangulated where there is parallax, else
// the depth of their neighbours in the image ("soft") until parallax comes.
#pragma once

#include <vector>

#include "drivers/geometric/bundle/triangulation.hpp"
#include "drivers/geometric/map/state.hpp"

namespace unisim::geometric {

class LandmarkGrowth {
 public:
  void reserve(size_t observations, size_t views);

  /// Triangulates one landmark from every view that counts.
  /// @param gate reprojection gate in pixels at the reference diagonal
  bool triangulate_landmark(State* state, int32_t slot, double gate);

  /// The step after the newest keyframe has its pose.
  /// @param large_step it had lost most of what the one before saw: two views do for a landmark
  void run(State* state, int32_t keyframe, bool large_step);

 private:
  struct Neighbour {
    Eigen::Vector2d pixel;
    double depth;
    double weight;
  };
  bool measurable(const State& state, int32_t slot, bool large_step);
  bool gather(const State& state, int32_t slot);
  void collect_neighbours(State* state, int32_t keyframe);
  void promote(State* state, int32_t slot);
  void guess_depth(State* state, int32_t slot, int32_t keyframe, const Eigen::Vector2d& pixel);

  std::vector<TriangulationView> views_;
  std::vector<Neighbour> neighbours_;
  std::vector<double> depths_;
};

}  // namespace unisim::geometric
