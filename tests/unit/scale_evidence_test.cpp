// SPDX-License-Identifier: MIT
// What is known of a unit in metres: fused by information, judged among its like.
#include "core/map/scale_evidence.hpp"

#include <cmath>
#include <vector>

#include "tests/support/catch.hpp"

using namespace unisim;

namespace {

ScaleEvidence all_of(std::vector<ScaleEvidence> all) {
  return fuse(Span<const ScaleEvidence>(all.data(), static_cast<int32_t>(all.size())));
}

Consensus consensus(std::vector<ScaleEvidence> all) {
  return consensus_of({all.data(), static_cast<int32_t>(all.size())});
}

Consensus consensus(const std::vector<double>& values) {
  std::vector<ScaleEvidence> all;
  for (const double value : values) all.push_back({value, 1e4});
  return consensus(all);
}

}  // namespace

TEST_CASE("two measurements weigh by their information") {
  const ScaleEvidence both = fuse({1.0, 100.0}, {2.0, 300.0});
  CHECK(both.log_metres == Approx(1.75));
  CHECK(both.information == Approx(400.0));
}

TEST_CASE("nothing known adds nothing") {
  const ScaleEvidence one = {0.7, 50.0};
  for (const ScaleEvidence& both : {fuse(one, {}), fuse({}, one)}) {
    CHECK(both.log_metres == Approx(0.7));
    CHECK(both.information == Approx(50.0));
  }
  CHECK_FALSE(fuse(ScaleEvidence{}, {}).known());
  CHECK_FALSE(all_of({}).known());
}

TEST_CASE("measurements that agree make each other surer, those that scatter do not") {
  CHECK(all_of({{1.0, 100.0}, {1.0, 100.0}, {1.0, 100.0}}).information == Approx(300.0));
  // chi2 = 100 (0.5^2 + 0.5^2) = 50 with one degree of freedom.
  CHECK(all_of({{1.0, 100.0}, {2.0, 100.0}}).information == Approx(4.0));
}

TEST_CASE("a longer unit has more metres") {
  const ScaleEvidence longer = ScaleEvidence{0.5, 10.0}.of_unit(0.25);
  CHECK(longer.log_metres == Approx(0.75));
  CHECK(longer.information == 10.0);
}

TEST_CASE("a value far from the others does not belong to them") {
  const Consensus others = consensus({1.0, 1.01, 0.99, 1.02, 0.98, 1.5});
  CHECK(others.center == Approx(1.0).margin(0.005));
  CHECK(others.weight({1.0, 1e4}) > 0.9);
  CHECK(others.weight({1.5, 1e4}) == 0.0);
  // One that is itself so unsure may be where it likes.
  CHECK(others.weight({1.5, 4.0}) > 0.5);
}

TEST_CASE("among fewer than five nobody can say which one is wrong") {
  CHECK(consensus({1.0, 1.0, 1.0, 9.0}).weight({9.0, 1e4}) == 1.0);
}

TEST_CASE("values that are off to one side do not draw the others after them") {
  // Two fifths of them 8 % too long, the others right to 1 %.
  std::vector<double> values;
  for (int k = 0; k < 20; ++k) {
    values.push_back(k % 5 < 2 ? 0.08 + 0.001 * k : 0.01 * std::sin(2.0 * k));
  }
  const Consensus most = consensus(values);
  CHECK(std::abs(most.center) < 0.006);
  CHECK(most.weight({0.08, 1e4}) == 0.0);
}
