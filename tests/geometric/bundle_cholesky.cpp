// SPDX-License-Identifier: MIT
// Tile Cholesky against a dense factorisation.
#include <Eigen/Cholesky>

#include "drivers/geometric/bundle/tile_cholesky.hpp"
#include "tests/geometric/bundle_scene.hpp"
#include "tests/support/catch.hpp"

using unisim::geometric::TileCholesky;

namespace {

// Random sparse positive definite matrix in `sparse` and, dense, as the answer.
Eigen::MatrixXd fill(int slots, double density, std::mt19937* random, TileCholesky* sparse) {
  const int n = 6 * slots;
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(n, n);
  sparse->begin(slots);
  for (int i = 0; i < slots; ++i) {
    for (int j = 0; j < i; ++j) {
      if (0.5 * (bundle_scene::uniform(random) + 1.0) > density) continue;
      sparse->mark(i, j);
      for (int k = 0; k < 36; ++k) {
        dense(6 * i + k % 6, 6 * j + k / 6) = bundle_scene::uniform(random);
      }
    }
  }
  dense = (dense + dense.transpose()).eval();
  for (int k = 0; k < n; ++k) dense(k, k) = 1.0 + dense.row(k).cwiseAbs().sum();
  sparse->analyze();
  sparse->clear();
  for (int i = 0; i < slots; ++i) {
    for (int j = 0; j <= i; ++j) {
      const Eigen::Matrix<double, 6, 6> block = dense.block<6, 6>(6 * i, 6 * j);
      if (!block.isZero()) sparse->block(i, j) += block;
    }
  }
  return dense;
}

}  // namespace

TEST_CASE("tile Cholesky solves as a dense one does") {
  std::mt19937 random(3);
  TileCholesky sparse(30);
  for (const int slots : {1, 3, 4, 5, 8, 17, 30}) {
    for (const double density : {0.0, 0.1, 0.5, 1.0}) {
      const Eigen::MatrixXd dense = fill(slots, density, &random, &sparse);
      Eigen::VectorXd b(6 * slots);
      for (int k = 0; k < b.size(); ++k) b[k] = bundle_scene::uniform(&random);
      Eigen::VectorXd x = Eigen::VectorXd::Zero(sparse.dimension());
      x.head(b.size()) = b;
      REQUIRE(sparse.factorize());
      sparse.forward(x.data(), 0);
      sparse.backward(x.data());
      INFO(slots << " slots, density " << density);
      REQUIRE((x.head(b.size()) - dense.llt().solve(b)).norm() < 1e-12);
      REQUIRE(x.tail(x.size() - b.size()).norm() == 0.0);
    }
  }
}

TEST_CASE("forward may start at the first slot that is not zero") {
  std::mt19937 random(4);
  TileCholesky sparse(20);
  fill(20, 0.3, &random, &sparse);
  REQUIRE(sparse.factorize());
  Eigen::VectorXd whole = Eigen::VectorXd::Zero(sparse.dimension());
  whole[6 * 13 + 2] = 1.0;
  Eigen::VectorXd late = whole;
  sparse.forward(whole.data(), 0);
  sparse.forward(late.data(), 13);
  REQUIRE((whole - late).norm() == 0.0);
}

TEST_CASE("tile Cholesky refuses a matrix that is not positive definite") {
  TileCholesky sparse(2);
  sparse.begin(2);
  sparse.mark(1, 0);
  sparse.analyze();
  sparse.clear();
  sparse.block(0, 0).setIdentity();
  sparse.block(1, 1).setIdentity();
  sparse.block(1, 0)(0, 0) = 2.0;
  REQUIRE_FALSE(sparse.factorize());
}
