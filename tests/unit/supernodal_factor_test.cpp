// SPDX-License-Identifier: MIT
// Factorisation, solves and inverse by each instruction set.
#include "core/solve/factor/supernodal_factor.hpp"

#include <array>
#include <cstring>
#include <vector>

#include "core/solve/factor/sparse_inverse.hpp"
#include "core/solve/order/block_map.hpp"
#include "tests/support/catch.hpp"
#include "tests/unit/core_support.hpp"

using namespace unisim;

#ifdef UNISIM_HAS_WIDE_VECTORS
namespace {

// Columns 0 and 1 are one supernode, column 2 is another, in whose row both have a block.
struct TwoSupernodes {
  std::array<int32_t, 3> first_column{0, 2, 3};
  std::array<int32_t, 3> of_column{0, 0, 1};
  std::array<int32_t, 3> row_start{0, 1, 1};
  std::array<int32_t, 1> rows{2};
  std::array<int32_t, 2> block_start{0, 5};
  std::array<int32_t, 3> first{}, next{}, position{}, place{};
  std::array<Staleness, 2> stale{Staleness::kFactor, Staleness::kFactor};
  std::array<Block, 6> blocks{};
  std::array<BlockVector, 3> H_diagonal{}, x{}, work{};

  TwoSupernodes() {
    unisim_test::Random random(3);
    for (Block& block : blocks) {
      for (int column = 0; column < kTangentDim; ++column) {
        for (int row = 0; row < kTangentDim; ++row) block.at(row, column) = random.uniform(-1, 1);
      }
    }
    for (const size_t diagonal : {0u, 2u, 5u}) {
      auto H = as_matrix(blocks[diagonal]);
      H = (H * H.transpose()).eval();
      H.diagonal().array() += 20.0;
    }
    for (BlockVector& part : x) {
      for (int d = 0; d < kTangentDim; ++d) part.v[d] = random.uniform(-1, 1);
    }
  }

  Supernodes layout() const {
    return {2,           first_column.data(), of_column.data(), row_start.data(),
            rows.data(), block_start.data()};
  }
  FactorTask task() {
    return {layout(),      {first.data(), next.data(), position.data(), place.data()},
            stale.data(),  1e-3,
            blocks.data(), H_diagonal.data(),
            x.data()};
  }
  InverseTask inverse() { return {layout(), blocks.data(), work.data(), place.data()}; }
};

bool equal(const TwoSupernodes& a, const TwoSupernodes& b) {
  return std::memcmp(a.blocks.data(), b.blocks.data(), sizeof a.blocks) == 0 &&
         std::memcmp(a.x.data(), b.x.data(), sizeof a.x) == 0;
}

}  // namespace

#define UNISIM_CHECK_AGAINST_BASELINE(isa)                                                       \
  do {                                                                                           \
    TwoSupernodes narrow;                                                                        \
    TwoSupernodes wide;                                                                          \
    REQUIRE(baseline::factorize_supernodes(narrow.task()) == -1);                                \
    REQUIRE(isa::factorize_supernodes(wide.task()) == -1);                                       \
    CHECK(equal(narrow, wide));                                                                  \
    baseline::backward_supernodes(narrow.layout(), narrow.blocks.data(), 0, 2, narrow.x.data()); \
    isa::backward_supernodes(wide.layout(), wide.blocks.data(), 0, 2, wide.x.data());            \
    CHECK(equal(narrow, wide));                                                                  \
    for (const int32_t s : {1, 0}) {                                                             \
      baseline::invert_supernode(narrow.inverse(), s);                                           \
      isa::invert_supernode(wide.inverse(), s);                                                  \
    }                                                                                            \
    CHECK(equal(narrow, wide));                                                                  \
  } while (false)

TEST_CASE("the factor has the same bits with vectors of 256 bits") {
  if (!cpu_has_avx2()) {
    WARN("skipped: the processor has no AVX2");
    return;
  }
  UNISIM_CHECK_AGAINST_BASELINE(avx2);
}

TEST_CASE("the factor has the same bits with vectors of 512 bits") {
  if (!cpu_has_avx512()) {
    WARN("skipped: the processor has no AVX-512");
    return;
  }
  UNISIM_CHECK_AGAINST_BASELINE(avx512);
}
#endif
