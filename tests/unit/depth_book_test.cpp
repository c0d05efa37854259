// SPDX-License-Identifier: MIT
// Depth of keyframes by unit: compared, kept, fallen back on.
#include "core/map/depth_book.hpp"

#include <cmath>
#include <vector>

#include "tests/support/catch.hpp"

using unisim::Arena;
using unisim::DepthBook;
using unisim::DepthBookSize;
using unisim::DepthMap;
using unisim::GridSize;
using unisim::LogMedianRatio;
using unisim::SampledDepth;

namespace {

constexpr int32_t kWidth = 32;
constexpr int32_t kHeight = 24;

struct BookFixture {
  BookFixture() : memory(1 << 20), arena(memory.data(), memory.size()), book(arena, size(), 0.25) {}

  static DepthBookSize size() {
    DepthBookSize size;
    size.keyframes = 8;
    size.two_view_slots = 2;
    size.submap_slots = 2;
    size.grid = {kWidth, kHeight};
    return size;
  }
  SampledDepth sample(float unit) {
    std::vector<float> pixels(kWidth * kHeight);
    for (size_t k = 0; k < pixels.size(); ++k) {
      pixels[k] = unit * (1.0F + 0.01F * static_cast<float>(k));
    }
    SampledDepth sampled(arena, {kWidth, kHeight});
    book.sample({pixels.data(), nullptr, kWidth, kHeight}, &sampled);
    return sampled;
  }

  std::vector<unsigned char> memory;
  Arena arena;
  DepthBook book;
};

}  // namespace

TEST_CASE("a sampled map keeps its depth while others are sampled, compared and kept") {
  BookFixture f;
  const SampledDepth one = f.sample(1.0F);
  const SampledDepth two = f.sample(2.0F);
  f.book.keep_two_view(two, 0);
  f.book.keep_two_view(one, 1);
  LogMedianRatio ratio = {};
  REQUIRE(f.book.over_two_view(one, 0, &ratio));
  CHECK(ratio.log_ratio == Approx(-std::log(2.0)).margin(1e-6));
  REQUIRE(f.book.over_two_view(two, 1, &ratio));
  CHECK(ratio.log_ratio == Approx(std::log(2.0)).margin(1e-6));
  CHECK(one.usable());
}

TEST_CASE("what has given way on the grid is found in the coarse archive") {
  BookFixture f;
  const SampledDepth map = f.sample(1.0F);
  for (int32_t keyframe = 0; keyframe < 6; ++keyframe) {
    f.book.begin_keyframe(keyframe);
    f.book.keep_two_view(map, keyframe);
  }
  LogMedianRatio ratio = {};
  REQUIRE(f.book.over_two_view(f.sample(3.0F), 0, &ratio));
  CHECK(ratio.log_ratio == Approx(std::log(3.0)).margin(2e-3));
  f.book.begin_keyframe(0);
  CHECK_FALSE(f.book.over_two_view(map, 0, &ratio));
}

TEST_CASE("a submap's view that was measured anew has its new depth") {
  BookFixture f;
  const SampledDepth map = f.sample(1.0F);
  f.book.keep_submap(map, {4, 7, 2});
  CHECK(f.book.submap_source(4).submap == 7);
  f.book.rescale_submap(7, 2, 2.0);
  LogMedianRatio ratio = {};
  REQUIRE(f.book.over_submap(map, 4, &ratio));
  CHECK(ratio.log_ratio == Approx(-std::log(2.0)).margin(1e-6));
  CHECK_FALSE(f.book.over_submap(map, 5, &ratio));
}

TEST_CASE("a map with next to no depth is of no use") {
  BookFixture f;
  std::vector<float> pixels(kWidth * kHeight, 0.0F);
  for (size_t k = 0; k < 15; ++k) pixels[k] = 1.0F;
  SampledDepth sampled(f.arena, {kWidth, kHeight});
  f.book.sample({pixels.data(), nullptr, kWidth, kHeight}, &sampled);
  CHECK_FALSE(sampled.usable());
}
