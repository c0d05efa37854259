// SPDX-License-Identifier: MIT
// Ratio of two depth maps.
#include "core/depth/log_median_ratio.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/catch.hpp"

using namespace unisim;

namespace {

struct Maps {
  std::vector<float> a, b;

  Status ratio(LogMedianRatio* out) {
    scratch.resize(a.size());
    return log_median_ratio(span(a), span(b),
                            Span<float>(scratch.data(), static_cast<int32_t>(scratch.size())), out);
  }
  static Span<const float> span(const std::vector<float>& v) {
    return {v.data(), static_cast<int32_t>(v.size())};
  }
  std::vector<float> scratch;
};

const float kNoNumber = std::numeric_limits<float>::quiet_NaN();
const float kInf = std::numeric_limits<float>::infinity();

}  // namespace

TEST_CASE("the ratio is the median and the scatter its median deviation") {
  Maps maps{{2, 4, 8, 3, 100}, {1, 1, 1, 1, 1}, {}};
  LogMedianRatio out{};
  REQUIRE(maps.ratio(&out) == Status::kOk);
  CHECK(out.log_ratio == Approx(std::log(4.0)));
  // deviations: log 2, 0, log 2, log 4/3, log 25 -> median log 2
  CHECK(out.scatter == Approx(std::log(2.0)));
  CHECK(out.count == 5);
}

TEST_CASE("pixels without depth in either map are left out") {
  Maps maps{{2, kNoNumber, 2, 0, -1, kInf, 2}, {1, 1, kNoNumber, 1, 1, 1, 0}, {}};
  LogMedianRatio out{};
  REQUIRE(maps.ratio(&out) == Status::kOk);
  CHECK(out.count == 1);
  CHECK(out.log_ratio == Approx(std::log(2.0)));
  CHECK(out.scatter == 0.0);
}

TEST_CASE("nothing in common is not ready and leaves the output") {
  Maps maps{{kNoNumber, 1}, {1, kNoNumber}, {}};
  LogMedianRatio out{7.0, 8.0, 9};
  CHECK(maps.ratio(&out) == Status::kNotReady);
  CHECK(out.count == 9);
}

TEST_CASE("wrong lengths and short scratch are refused") {
  Maps maps{{1, 1}, {1, 1}, {}};
  LogMedianRatio out{};
  REQUIRE(maps.ratio(&out) == Status::kOk);
  CHECK(log_median_ratio(Maps::span(maps.a), Maps::span(maps.b),
                         Span<float>(maps.scratch.data(), 1), &out) == Status::kInvalidArgument);
  maps.b.push_back(1);
  CHECK(maps.ratio(&out) == Status::kInvalidArgument);
}
