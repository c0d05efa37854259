// SPDX-License-Identifier: MIT
// Cholesky factorisation of a symmetric matrix of 6x6 blocks kept in square tiles; empty tiles cost
// nothing.
#include "drivers/geometric/bundle/tile_cholesky.hpp"

#include <algorithm>
#include <cmath>

namespace unisim::geometric {
namespace {

constexpr int kTile = TileCholesky::kTile;
constexpr int kMicro = 4;

using ConstStrip = Eigen::Map<const Eigen::Matrix<double, kMicro, 1>>;
using MicroTile = Eigen::Map<Eigen::Matrix<double, kMicro, kMicro>, 0, Eigen::OuterStride<kTile>>;
using TileMap = Eigen::Map<Eigen::Matrix<double, kTile, kTile>>;
using ConstTileMap = Eigen::Map<const Eigen::Matrix<double, kTile, kTile>>;
using TileVector = Eigen::Map<Eigen::Matrix<double, kTile, 1>>;
using ConstTileVector = Eigen::Map<const Eigen::Matrix<double, kTile, 1>>;

// c -= a b^T, tiles column-major. A 4x4 corner of c stays in registers over the whole inner sum.
void subtract_product(const double* a, const double* b, double* c) {
  for (int column = 0; column < kTile; column += kMicro) {
    for (int row = 0; row < kTile; row += kMicro) {
      MicroTile corner(c + row + column * kTile, Eigen::OuterStride<kTile>(kTile));
      Eigen::Matrix<double, kMicro, kMicro> sum = corner;
      for (int k = 0; k < kTile; ++k) {
        const ConstStrip left(a + row + k * kTile);
        const double* right = b + column + k * kTile;
        sum.col(0) -= left * right[0];
        sum.col(1) -= left * right[1];
        sum.col(2) -= left * right[2];
        sum.col(3) -= left * right[3];
      }
      corner = sum;
    }
  }
}

// Lower Cholesky factor of a tile in place.
bool factorize_tile(double* a) {
  TileMap A(a);
  for (int k = 0; k < kTile; ++k) {
    const double pivot = A(k, k);
    if (!(pivot > 0.0) || !std::isfinite(pivot)) return false;
    const double root = std::sqrt(pivot);
    const double inverse = 1.0 / root;
    A(k, k) = root;
    for (int i = k + 1; i < kTile; ++i) A(i, k) *= inverse;
    for (int j = k + 1; j < kTile; ++j) {
      const double scale = A(j, k);
      for (int i = j; i < kTile; ++i) A(i, j) -= scale * A(i, k);
    }
  }
  return true;
}

// a <- a L^-T with L the lower factor in `l`.
void solve_right(const double* l, double* a) {
  const ConstTileMap L(l);
  TileMap A(a);
  for (int k = 0; k < kTile; ++k) {
    for (int j = 0; j < k; ++j) A.col(k) -= L(k, j) * A.col(j);
    A.col(k) *= 1.0 / L(k, k);
  }
}

}  // namespace

TileCholesky::TileCholesky(int max_slots) {
  const int tiles = (std::max(max_slots, 1) + kSlotsPerTile - 1) / kSlotsPerTile;
  stored_.assign(tile_index(tiles, 0), 0);
  data_.assign(tile_index(tiles, 0) * kTile * kTile, 0.0);
}

void TileCholesky::begin(int slots) {
  slots_ = slots;
  tiles_ = (slots + kSlotsPerTile - 1) / kSlotsPerTile;
  std::fill(stored_.begin(), stored_.end(), std::uint8_t{0});
  for (int i = 0; i < tiles_; ++i) stored_[tile_index(i, i)] = 1;
}

void TileCholesky::mark(int row_slot, int column_slot) {
  stored_[tile_index(row_slot / kSlotsPerTile, column_slot / kSlotsPerTile)] = 1;
}

void TileCholesky::analyze() {
  for (int j = 0; j < tiles_; ++j) {
    for (int i = j + 1; i < tiles_; ++i) {
      if (!stored(i, j)) continue;
      for (int k = i + 1; k < tiles_; ++k) {
        if (stored(k, j)) stored_[tile_index(k, i)] = 1;
      }
    }
  }
}

void TileCholesky::clear() {
  for (int i = 0; i < tiles_; ++i) {
    for (int j = 0; j <= i; ++j) {
      if (stored(i, j)) TileMap(tile(i, j)).setZero();
    }
  }
  for (int row = kBlock * slots_; row < dimension(); ++row) {
    TileMap(tile(tiles_ - 1, tiles_ - 1))(row % kTile, row % kTile) = 1.0;
  }
}

void TileCholesky::update_column(int column) {
  for (int k = 0; k < column; ++k) {
    if (!stored(column, k)) continue;
    for (int i = column; i < tiles_; ++i) {
      if (stored(i, k)) subtract_product(tile(i, k), tile(column, k), tile(i, column));
    }
  }
}

bool TileCholesky::factorize() {
  for (int j = 0; j < tiles_; ++j) {
    update_column(j);
    if (!factorize_tile(tile(j, j))) return false;
    for (int i = j + 1; i < tiles_; ++i) {
      if (stored(i, j)) solve_right(tile(j, j), tile(i, j));
    }
  }
  return true;
}

void TileCholesky::forward(double* x, int first_slot) const {
  for (int i = first_slot / kSlotsPerTile; i < tiles_; ++i) {
    TileVector y(x + i * kTile);
    for (int j = first_slot / kSlotsPerTile; j < i; ++j) {
      if (stored(i, j)) y.noalias() -= ConstTileMap(tile(i, j)) * ConstTileVector(x + j * kTile);
    }
    const ConstTileMap L(tile(i, i));
    for (int k = 0; k < kTile; ++k) {
      y(k) /= L(k, k);
      for (int r = k + 1; r < kTile; ++r) y(r) -= L(r, k) * y(k);
    }
  }
}

void TileCholesky::backward(double* x) const {
  for (int i = tiles_ - 1; i >= 0; --i) {
    TileVector y(x + i * kTile);
    for (int j = i + 1; j < tiles_; ++j) {
      if (!stored(j, i)) continue;
      y.noalias() -= ConstTileMap(tile(j, i)).transpose() * ConstTileVector(x + j * kTile);
    }
    const ConstTileMap L(tile(i, i));
    for (int k = kTile - 1; k >= 0; --k) {
      for (int r = k + 1; r < kTile; ++r) y(k) -= L(r, k) * y(r);
      y(k) /= L(k, k);
    }
  }
}

std::size_t TileCholesky::memory_bytes() const {
  return data_.capacity() * sizeof(double) + stored_.capacity();
}

}  // namespace unisim::geometric
