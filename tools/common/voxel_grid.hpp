// SPDX-License-Identifier: MIT
// Points thinned to one per cube of space, in memory with a limit.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace unisim::tools {

/// The points of one cube, as one: their weighted means.
struct VoxelPoint {
  std::array<double, 3> position{};
  std::array<double, 3> colour{};  ///< red green blue, in the unit they came in
  double confidence = 0.0;         ///< the largest
  int64_t count = 0;               ///< points that fell in
};

/// Cubes of space in the order in which they were met first. With more cubes than fit the side of
/// all doubles: memory has a limit, whatever comes.
class VoxelGrid {
 public:
  /// @param side     of a cube, above 0
  /// @param capacity most cubes, at least 8
  /// @param expected points that will come: memory for their cubes is taken at once
  VoxelGrid(double side, size_t capacity, size_t expected = 0);

  /// One more point. @param weight above 0
  void add(const std::array<double, 3>& position, const std::array<double, 3>& colour,
           double confidence, double weight);

  double side() const { return side_; }
  size_t size() const { return cells_.size(); }
  VoxelPoint point(size_t k) const;

 private:
  struct Cell {
    std::array<int64_t, 3> key;
    std::array<double, 3> position;  // sums, times weight
    std::array<double, 3> colour;
    double weight;
    double confidence;
    int64_t count;
  };

  void put(const Cell& cell);
  size_t slot_of(const std::array<int64_t, 3>& key) const;
  void coarsen();

  double side_;
  size_t capacity_;
  std::vector<Cell> cells_;
  std::vector<uint32_t> slots_;  // 1 + index into cells_, 0: free; at most half of them used
};

}  // namespace unisim::tools
