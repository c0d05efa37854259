// SPDX-License-Identifier: MIT
// Block Cholesky: a worked example, capacities, bad pivots.
#include "core/solve/factor/block_cholesky.hpp"

#include <vector>

#include "tests/support/catch.hpp"
#include "tests/unit/core_support.hpp"

using namespace unisim;
using CarvedCholesky = unisim_test::Carved<BlockCholesky, SolverCapacity>;

namespace {

// Blocks 0-1 and 0-2 of [[4, 2, 2], [2, 5, 0], [2, 0, 6]] times the 7x7 identity: factor
// [[2], [1, 2], [1, -1/2, sqrt(4.75)]], so 1-2 fills in.
struct Example {
  std::vector<int32_t> start{0, 2, 2, 2};
  std::vector<int32_t> rows{1, 2};
  std::vector<Block> diagonal{scaled_identity(4), scaled_identity(5), scaled_identity(6)};
  std::vector<Block> off_diagonal{scaled_identity(2), scaled_identity(2)};

  static Block scaled_identity(double factor) {
    Block block{};
    for (int i = 0; i < 7; ++i) block.at(i, i) = factor;
    return block;
  }
  Span<const int32_t> column_start() const { return {start.data(), 4}; }
  Span<const int32_t> row_list() const { return {rows.data(), 2}; }
  Status factorize(BlockCholesky& cholesky, double lambda) const {
    cholesky.mark_all_stale();
    const Assembly target = cholesky.begin_assembly();
    for (size_t j = 0; j < 3; ++j) {
      target.open(static_cast<int32_t>(j));
      target.blocks[target.diagonal[j]] = diagonal[j];
    }
    for (size_t p = 0; p < 2; ++p) target.blocks[target.off_diagonal[p]] = off_diagonal[p];
    return cholesky.factorize(lambda);
  }
};

}  // namespace

TEST_CASE("three blocks with one fill-in are solved") {
  const Example example;
  CarvedCholesky cholesky({3, 2, 2, 6});
  REQUIRE(cholesky.fits());
  REQUIRE(cholesky->analyze(example.column_start(), example.row_list()) == Status::kOk);
  CHECK(cholesky->needed_blocks() == 6);
  REQUIRE(example.factorize(*cholesky, 0.0) == Status::kOk);
  std::vector<BlockVector> x(3);
  for (int i = 0; i < 7; ++i) {
    x[0].v[i] = 8.0 * i;  // H (1, 1, 1)' i
    x[1].v[i] = 7.0 * i;
    x[2].v[i] = 8.0 * i;
  }
  cholesky->solve({x.data(), 3});
  for (int i = 0; i < 7; ++i) {
    CHECK(x[0].v[i] == Approx(1.0 * i));
    CHECK(x[1].v[i] == Approx(1.0 * i));
    CHECK(x[2].v[i] == Approx(1.0 * i));
  }
}

TEST_CASE("damping multiplies the diagonal") {
  const Example example;
  CarvedCholesky cholesky({3, 2, 2, 6});
  REQUIRE(cholesky->analyze(example.column_start(), example.row_list()) == Status::kOk);
  REQUIRE(example.factorize(*cholesky, 1.0) == Status::kOk);
  std::vector<BlockVector> x(3);
  x[0].v[0] = 12.0;  // rows of [[8, 2, 2], [2, 10, 0], [2, 0, 12]] summed
  x[1].v[0] = 12.0;
  x[2].v[0] = 14.0;
  cholesky->solve({x.data(), 3});
  for (const BlockVector& value : x) CHECK(value.v[0] == Approx(1.0));
}

TEST_CASE("one factor block more than declared is refused with the number needed") {
  const Example example;
  CarvedCholesky cholesky({3, 2, 2, 5});
  CHECK(cholesky->analyze(example.column_start(), example.row_list()) == Status::kCapacity);
  CHECK(cholesky->needed_blocks() == 6);
}

TEST_CASE("a bad pivot names its column and the next factorisation works") {
  Example example;
  CarvedCholesky cholesky({3, 2, 2, 6});
  REQUIRE(cholesky->analyze(example.column_start(), example.row_list()) == Status::kOk);
  example.diagonal[1].at(4, 4) = 1.0;  // 1 - 2 * 2 / 4: singular
  CHECK(example.factorize(*cholesky, 0.0) == Status::kNumerical);
  CHECK(cholesky->bad_column() == 1);
  example.diagonal[1].at(4, 4) = -5.0;
  CHECK(example.factorize(*cholesky, 0.0) == Status::kNumerical);
  CHECK(cholesky->bad_column() == 1);
  example.diagonal[1].at(4, 4) = 5.0;
  CHECK(example.factorize(*cholesky, 0.0) == Status::kOk);
  CHECK(cholesky->bad_column() == -1);
}

TEST_CASE("the inverse block of the example") {
  const Example example;
  CarvedCholesky cholesky({3, 2, 2, 6});
  REQUIRE(cholesky->analyze(example.column_start(), example.row_list()) == Status::kOk);
  REQUIRE(example.factorize(*cholesky, 0.0) == Status::kOk);
  std::vector<BlockVector> work(3);
  Mat7 block;
  cholesky->inverse_block(0, {work.data(), 3}, &block);
  CHECK(unisim_test::difference(block, (30.0 / 76.0) * Mat7::Identity()) < 1e-15);
  cholesky->inverse_block(2, {work.data(), 3}, &block);
  CHECK(unisim_test::difference(block, (16.0 / 76.0) * Mat7::Identity()) < 1e-15);
}
