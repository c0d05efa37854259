// SPDX-License-Identifier: MIT
// Cholesky factorisation of a symmetric matrix of 6x6 blocks kept in square tiles; empty tiles cost
// nothing.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace unisim::geometric {

/// Symmetric positive definite matrix of up to `max_slots` x `max_slots` blocks of 6x6, lower half
/// only, in tiles of kSlotsPerTile slots. Only tiles marked by mark() and those that fill in are
/// stored to, cleared and multiplied. Rows past 6 * slots are identity.
///
/// Use: begin(), mark() every block that may be nonzero, analyze(); then as often as wanted:
/// clear(), block(), factorize(), forward(), backward(). Nothing allocates after construction.
class TileCholesky {
 public:
  static constexpr int kBlock = 6;
  static constexpr int kSlotsPerTile = 4;
  static constexpr int kTile = kBlock * kSlotsPerTile;
  using Block = Eigen::Map<Eigen::Matrix<double, kBlock, kBlock>, 0, Eigen::OuterStride<kTile>>;

  explicit TileCholesky(int max_slots);

  void begin(int slots);
  void mark(int row_slot, int column_slot);  ///< row_slot >= column_slot
  void analyze();                            ///< adds the tiles that fill in

  void clear();  ///< all stored tiles to zero, rows past the end to identity
  /// Block of the lower half; of a diagonal block both halves are given, the lower one is read.
  Block block(int row_slot, int column_slot) {
    double* corner = tile(row_slot / kSlotsPerTile, column_slot / kSlotsPerTile) +
                     kBlock * (row_slot % kSlotsPerTile) +
                     kBlock * (column_slot % kSlotsPerTile) * kTile;
    return Block(corner, Eigen::OuterStride<kTile>(kTile));
  }

  /// A = L L^T in place. False when a pivot is not positive; contents are then of no use.
  bool factorize();
  /// x <- L^-1 x, x of dimension() entries; entries before `first_slot` must be zero.
  void forward(double* x, int first_slot) const;
  void backward(double* x) const;  ///< x <- L^-T x

  /// Diagonal block of a slot, after factorize() that of L (entries above the diagonal mean
  /// nothing).
  Eigen::Matrix<double, kBlock, kBlock> diagonal_block(int slot) const {
    const int corner = kBlock * (slot % kSlotsPerTile);
    return Eigen::Map<const Eigen::Matrix<double, kTile, kTile>>(
               tile(slot / kSlotsPerTile, slot / kSlotsPerTile))
        .block<kBlock, kBlock>(corner, corner);
  }

  int dimension() const { return kTile * tiles_; }  ///< rows with padding
  std::size_t memory_bytes() const;

 private:
  static std::size_t tile_index(int row, int column) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(row + 1) / 2 +
           static_cast<std::size_t>(column);
  }
  double* tile(int row, int column) { return &data_[tile_index(row, column) * kTile * kTile]; }
  const double* tile(int row, int column) const {
    return &data_[tile_index(row, column) * kTile * kTile];
  }
  bool stored(int row, int column) const { return stored_[tile_index(row, column)] != 0; }
  void update_column(int column);

  int slots_ = 0;
  int tiles_ = 0;
  std::vector<double> data_;
  std::vector<std::uint8_t> stored_;
};

}  // namespace unisim::geometric
