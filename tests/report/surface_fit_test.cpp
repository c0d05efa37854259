// SPDX-License-Identifier: MIT
// Depth between sparse measured pixels: planes stay planes, edges stay edges.
#include "tools/replay/surface_fit.hpp"

#include <cmath>

#include "tests/support/catch.hpp"

using unisim::replay::SurfaceFit;

namespace {

constexpr int kFitColumns = 40;
constexpr int kFitRows = 30;

/// Every fourth pixel of every third row is measured.
struct Sparse {
  std::vector<float> depth = std::vector<float>(size_t{kFitColumns} * kFitRows, 0.0F);
  std::vector<float> confidence = std::vector<float>(size_t{kFitColumns} * kFitRows, 0.0F);
  std::vector<SurfaceFit::Rgb> colours;

  template <typename Depth>
  explicit Sparse(Depth depth_at) {
    for (int row = 0; row < kFitRows; row += 3) {
      for (int column = row % 2; column < kFitColumns; column += 4) {
        const size_t at = index(column, row);
        depth[at] = depth_at(column, row);
        confidence[at] = 1.0F;
      }
    }
  }

  static size_t index(int column, int row) {
    return static_cast<size_t>(row) * kFitColumns + static_cast<size_t>(column);
  }

  const unisim_depth_map& filled(SurfaceFit* fit) const {
    return fit->fill({depth.data(), confidence.data(), kFitColumns, kFitRows}, 0.75F, colours);
  }
};

float slanted(int column, int row) {
  return 1.0F / (0.3F + 0.01F * static_cast<float>(column) - 0.004F * static_cast<float>(row));
}

float step(int column, int /*row*/) { return column < kFitColumns / 2 ? 1.0F : 2.0F; }

}  // namespace

TEST_CASE("between points of a slanted plane lies the plane") {
  SurfaceFit fit;
  const Sparse sparse(slanted);
  const unisim_depth_map& map = sparse.filled(&fit);
  REQUIRE(map.width == kFitColumns);
  REQUIRE(map.height == kFitRows);
  for (int row = 4; row < kFitRows - 4; ++row) {
    for (int column = 4; column < kFitColumns - 4; ++column) {
      const size_t at = Sparse::index(column, row);
      CHECK(map.depth[at] == Approx(slanted(column, row)).epsilon(0.005));
      CHECK(map.confidence[at] > 0.2F);
    }
  }
}

TEST_CASE("measured pixels are kept as they are, guessed ones are not") {
  SurfaceFit fit;
  Sparse sparse(slanted);
  sparse.depth[Sparse::index(16, 12)] *= 1.1F;
  sparse.depth[Sparse::index(17, 12)] = 99.0F;
  sparse.confidence[Sparse::index(17, 12)] = 0.5F;
  const unisim_depth_map& map = sparse.filled(&fit);
  CHECK(map.depth[Sparse::index(16, 12)] == sparse.depth[Sparse::index(16, 12)]);
  CHECK(map.confidence[Sparse::index(16, 12)] == 1.0F);
  CHECK(map.depth[Sparse::index(17, 12)] == Approx(slanted(17, 12)).epsilon(0.05));
}

TEST_CASE("at an edge pixels lie on one side or are less sure") {
  SurfaceFit fit;
  Sparse sparse(step);
  for (int row = 0; row < kFitRows; ++row) {
    for (int column = 0; column < kFitColumns; ++column) {
      const auto level = static_cast<uint8_t>(column < kFitColumns / 2 ? 30 : 200);
      sparse.colours.push_back({level, level, level});
    }
  }
  const unisim_depth_map& map = sparse.filled(&fit);
  for (int column = kFitColumns / 2 - 2; column < kFitColumns / 2 + 2; ++column) {
    for (int row = 4; row < kFitRows - 4; ++row) {
      const size_t at = Sparse::index(column, row);
      CHECK(map.depth[at] == Approx(step(column, row)).epsilon(0.05));
      if (map.confidence[at] < 1.0F) CHECK(map.confidence[at] < 0.3F);
    }
  }
}

TEST_CASE("far from all that is measured there is no depth") {
  SurfaceFit fit;
  Sparse sparse([](int column, int) { return column < 12 ? 2.0F : 0.0F; });
  const unisim_depth_map& map = sparse.filled(&fit);
  CHECK(map.depth[Sparse::index(30, 15)] == 0.0F);
  CHECK(map.confidence[Sparse::index(30, 15)] == 0.0F);
  CHECK(map.confidence[Sparse::index(16, 15)] < 0.2F);
}
