// SPDX-License-Identifier: MIT
// Points thinned to one per cube of space, in memory with a limit.
#include "tools/common/voxel_grid.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace unisim::tools {
namespace {

// Cubes are counted from the origin; what lies farther shares the outermost.
constexpr double kFarthestKey = 1e15;

int64_t key_of(double value, double side) {
  return static_cast<int64_t>(std::floor(std::clamp(value / side, -kFarthestKey, kFarthestKey)));
}

uint64_t mix(const std::array<int64_t, 3>& key) {
  uint64_t hash = 0;
  for (const int64_t part : key) {
    hash = (hash ^ static_cast<uint64_t>(part)) * 0x9e3779b97f4a7c15ULL;
    hash ^= hash >> 29U;
  }
  return hash;
}

/// Of arrays the library would compare bytes by a call, which takes as long as all the rest.
bool same(const std::array<int64_t, 3>& a, const std::array<int64_t, 3>& b) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

}  // namespace

VoxelGrid::VoxelGrid(double side, size_t capacity, size_t expected)
    : side_(side), capacity_(std::max<size_t>(capacity, 8)) {
  const size_t cubes = std::min(expected, capacity_);
  cells_.reserve(cubes);
  size_t slots = 64;
  while (slots < 2 * cubes) slots *= 2;
  slots_.assign(slots, 0);
}

size_t VoxelGrid::slot_of(const std::array<int64_t, 3>& key) const {
  size_t slot = mix(key) & (slots_.size() - 1);
  while (slots_[slot] != 0 && !same(cells_[slots_[slot] - 1].key, key))
    slot = (slot + 1) & (slots_.size() - 1);
  return slot;
}

void VoxelGrid::put(const Cell& cell) {
  const size_t slot = slot_of(cell.key);
  if (slots_[slot] != 0) {
    Cell& into = cells_[slots_[slot] - 1];
    for (size_t i = 0; i < 3; ++i) {
      into.position[i] += cell.position[i];
      into.colour[i] += cell.colour[i];
    }
    into.weight += cell.weight;
    into.confidence = std::max(into.confidence, cell.confidence);
    into.count += cell.count;
    return;
  }
  cells_.push_back(cell);
  slots_[slot] = static_cast<uint32_t>(cells_.size());
  if (2 * cells_.size() <= slots_.size()) return;
  slots_.assign(2 * slots_.size(), 0);
  for (size_t k = 0; k < cells_.size(); ++k)
    slots_[slot_of(cells_[k].key)] = static_cast<uint32_t>(k + 1);
}

void VoxelGrid::add(const std::array<double, 3>& position, const std::array<double, 3>& colour,
                    double confidence, double weight) {
  Cell cell{{}, {}, {}, weight, confidence, 1};
  for (size_t i = 0; i < 3; ++i) {
    cell.position[i] = weight * position[i];
    cell.colour[i] = weight * colour[i];
    cell.key[i] = key_of(position[i], side_);
  }
  put(cell);
  while (cells_.size() > capacity_) coarsen();
}

void VoxelGrid::coarsen() {
  side_ *= 2;
  std::vector<Cell> old = std::exchange(cells_, {});
  std::fill(slots_.begin(), slots_.end(), 0);
  for (Cell& cell : old) {
    // Two cubes side by side become one: the shift rounds down, also below zero.
    for (int64_t& part : cell.key) part >>= 1;
    put(cell);
  }
}

VoxelPoint VoxelGrid::point(size_t k) const {
  const Cell& cell = cells_[k];
  VoxelPoint point{cell.position, cell.colour, cell.confidence, cell.count};
  for (size_t i = 0; i < 3; ++i) {
    point.position[i] /= cell.weight;
    point.colour[i] /= cell.weight;
  }
  return point;
}

}  // namespace unisim::tools
