// SPDX-License-Identifier: MIT
// Dense kernels on padded blocks against Eigen.
#include "core/solve/factor/block_kernels.hpp"

#include <limits>

#include "core/solve/order/block_map.hpp"
#include "tests/support/catch.hpp"
#include "tests/unit/core_support.hpp"

using namespace unisim;
using namespace unisim::baseline;
using unisim_test::difference;

namespace {

using Dense = Eigen::Matrix<double, 7, 7>;
using DenseVector = Eigen::Matrix<double, 7, 1>;
const double kNoFloor[kTangentDim] = {};

Block random_block(unisim_test::Random& random) {
  Block block{};
  for (int c = 0; c < 7; ++c) {
    for (int r = 0; r < 7; ++r) block.at(r, c) = random.uniform(-1, 1);
  }
  return block;
}

Block positive_block(unisim_test::Random& random) {
  const Block a = random_block(random);
  Block out{};
  as_matrix(out) = as_matrix(a) * as_matrix(a).transpose() + 0.1 * Dense::Identity();
  return out;
}

BlockVector random_vector(unisim_test::Random& random) {
  BlockVector x{};
  for (int i = 0; i < 7; ++i) x.v[i] = random.uniform(-1, 1);
  return x;
}

DenseVector dense(const BlockVector& x) { return Eigen::Map<const DenseVector>(x.v); }

bool padding_is_zero(const Block& block) {
  for (int c = 0; c < 7; ++c) {
    if (block.at(7, c) != 0.0) return false;
  }
  return true;
}

// L of a block that invert_factor() has left.
Dense lower_factor(const Block& inverted) { return as_matrix(inverted).transpose().inverse(); }

}  // namespace

TEST_CASE("subtract_products and subtract_grams") {
  unisim_test::Random random(1);
  for (int trial = 0; trial < 20; ++trial) {
    const Block A = random_block(random);
    const Block B = random_block(random);
    Block C = random_block(random);
    const Dense expected = as_matrix(C) - as_matrix(A) * as_matrix(B).transpose();
    subtract_products(C, &A, &B, 1);
    CHECK(difference(as_matrix(C), expected) < 1e-14);
    CHECK(padding_is_zero(C));
    Block G = positive_block(random);
    const Dense gram = as_matrix(G) - as_matrix(A) * as_matrix(A).transpose();
    subtract_grams(G, &A, 1);
    const Dense lower = (as_matrix(G) - gram).triangularView<Eigen::Lower>();
    CHECK(lower.cwiseAbs().maxCoeff() < 1e-14);
  }
}

TEST_CASE("invert_factor and the solves") {
  unisim_test::Random random(2);
  for (int trial = 0; trial < 20; ++trial) {
    const Block D = positive_block(random);
    Block L = D;
    REQUIRE(invert_factor(L, kNoFloor));
    const Dense dense_L = lower_factor(L);
    CHECK(difference(dense_L * dense_L.transpose(), as_matrix(D)) < 1e-14);
    BlockVector x = random_vector(random);
    const DenseVector b = dense(x);
    solve_lower(L, x);
    CHECK(difference(dense_L * dense(x), b) < 1e-12);
    BlockVector y = random_vector(random);
    const DenseVector c = dense(y);
    solve_lower_transposed(L, y);
    CHECK(difference(dense_L.transpose() * dense(y), c) < 1e-12);
    Block C = random_block(random);
    const Dense before = as_matrix(C);
    solve_right(C, L);
    CHECK(difference(as_matrix(C) * dense_L.transpose(), before) < 1e-12);
    CHECK(padding_is_zero(C));
  }
}

TEST_CASE("products with vectors") {
  unisim_test::Random random(3);
  const Block A = random_block(random);
  const BlockVector x = random_vector(random);
  BlockVector y = random_vector(random);
  const DenseVector expected = dense(y) - as_matrix(A) * dense(x);
  subtract_times(y, &A, &x, 1);
  CHECK(difference(dense(y), expected) < 1e-14);
  const DenseVector transposed = dense(y) - as_matrix(A).transpose() * dense(x);
  TransposedSum sum;
  sum.clear();
  sum.add(A, x);
  sum.subtract_from(y);
  CHECK(difference(dense(y), transposed) < 1e-14);
  CHECK(y.v[7] == 0.0);
}

TEST_CASE("pivots that are not positive, below their floor or not finite are refused") {
  Block identity{};
  as_matrix(identity).setIdentity();
  Block D = identity;
  CHECK(invert_factor(D, kNoFloor));
  D = identity;
  D.at(3, 3) = 0.0;
  CHECK_FALSE(invert_factor(D, kNoFloor));
  D = identity;
  D.at(6, 6) = -1.0;
  CHECK_FALSE(invert_factor(D, kNoFloor));
  D = identity;
  D.at(0, 0) = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(invert_factor(D, kNoFloor));
  D = identity;
  D.at(0, 0) = std::numeric_limits<double>::infinity();
  CHECK_FALSE(invert_factor(D, kNoFloor));
  const double floor[kTangentDim] = {0, 0, 0, 0, 2, 0, 0};
  D = identity;
  CHECK_FALSE(invert_factor(D, floor));
}
