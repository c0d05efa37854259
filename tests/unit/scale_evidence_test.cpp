// SPDX-License-Identifier: MIT
// What is known of a unit in metres: fused by information, judged among its like.
#include "core/map/scale_evidence.hpp"

#include <vector>

#include "tests/support/catch.hpp"

using namespace unisim;

namespace {

ScaleEvidence all_of(std::vector<ScaleEvidence> all) {
  return fuse(Span<const ScaleEvidence>(all.data(), static_cast<int32_t>(all.size())));
}

Consensus consensus(std::vector<double> values) {
  return consensus_of({values.data(), static_cast<int32_t>(values.size())});
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
  CHECK_FALSE(fuse({}, {}).known());
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
  CHECK(others.median == Approx(1.005));
  CHECK(others.accepts(1.05, 1e4));
  CHECK_FALSE(others.accepts(1.5, 1e4));
  // One that is itself so unsure may be where it likes.
  CHECK(others.accepts(1.5, 16.0));
}

TEST_CASE("among fewer than five nobody can say which one is wrong") {
  CHECK(consensus({1.0, 1.0, 1.0, 9.0}).accepts(9.0, 1e4));
}
