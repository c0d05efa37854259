// SPDX-License-Identifier: MIT
// Association of poses by time.
#include "tools/eval/association.hpp"

#include "tests/eval/trajectories.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::eval;

namespace {

Trajectory at_times(const std::vector<double>& times) {
  Trajectory trajectory{"made", "tum", {}, 0};
  for (const double t : times) {
    trajectory.poses.push_back({t, Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()});
  }
  return trajectory;
}

void require_pairs(const std::vector<IndexPair>& pairs,
                   const std::vector<std::pair<size_t, size_t>>& expected) {
  REQUIRE(pairs.size() == expected.size());
  for (size_t k = 0; k < pairs.size(); ++k) {
    REQUIRE(pairs[k].ground_truth == expected[k].first);
    REQUIRE(pairs[k].estimate == expected[k].second);
  }
}

}  // namespace

TEST_CASE("each pose of the shorter trajectory takes the nearest of the longer") {
  require_pairs(associate(at_times({0.0, 1.0, 2.0, 3.0}), at_times({0.9, 2.05, 7.0}), 0.2),
                {{1, 0}, {2, 1}});
  require_pairs(associate(at_times({0.9, 2.05, 7.0}), at_times({0.0, 1.0, 2.0, 3.0}), 0.2),
                {{0, 1}, {1, 2}});
}

TEST_CASE("a difference of just max_dt still counts") {
  require_pairs(associate(at_times({1.0, 5.0}), at_times({1.5}), 0.5), {{0, 0}});
  REQUIRE_THROWS_AS(associate(at_times({1.0, 5.0}), at_times({1.75}), 0.5), InputError);
}

TEST_CASE("of two equally near times the earlier is taken") {
  require_pairs(associate(at_times({1.0, 2.0}), at_times({1.5}), 1.0), {{0, 0}});
}

TEST_CASE("a pose may serve twice, as with evo") {
  require_pairs(associate(at_times({1.0, 9.0, 10.0}), at_times({0.9, 1.1}), 0.2), {{0, 0}, {0, 1}});
}

TEST_CASE("clocks that do not meet are refused with both ranges") {
  try {
    associate(at_times({1000.5, 1001.0}), at_times({0.25, 2.0}), 0.02);
    FAIL("associated");
  } catch (const ScoreError& error) {
    const std::string text = error.what();
    REQUIRE(text.find("1000.500000 to 1001.000000 s") != std::string::npos);
    REQUIRE(text.find("0.250000 to 2.000000 s") != std::string::npos);
    REQUIRE(text.find("--") == std::string::npos);
    REQUIRE(error.kind() == ScoreError::Kind::kNoPairs);
  }
}

TEST_CASE("frame numbers and times do not compare") {
  Trajectory kitti = at_times({0, 1, 2});
  kitti.format = "kitti";
  REQUIRE_THROWS_AS(associate(kitti, at_times({0, 1, 2}), 0.02), InputError);
  require_pairs(associate(kitti, kitti, 0.02), {{0, 0}, {1, 1}, {2, 2}});
}

TEST_CASE("matrices without frame numbers are paired by line only where both have as many") {
  const auto by_line = [](const std::vector<double>& numbers, int64_t lines) {
    Trajectory kitti = at_times(numbers);
    kitti.format = "kitti";
    kitti.by_line = true;
    kitti.lines = lines;
    return kitti;
  };
  Trajectory numbered = at_times({0, 4, 8});
  numbered.format = "kitti";
  const Trajectory all = by_line({0, 1, 2, 3, 4, 5, 6, 7, 8}, 9);
  require_pairs(associate(all, by_line({0, 2, 8}, 9), 0.02), {{0, 0}, {2, 1}, {8, 2}});
  REQUIRE_THROWS_WITH(associate(all, by_line({0, 1, 2}, 3), 0.02),
                      Catch::Contains("9 lines") && Catch::Contains("3 lines"));
  require_pairs(associate(all, numbered, 0.02), {{0, 0}, {4, 1}, {8, 2}});
  require_pairs(associate(numbered, all, 0.02), {{0, 0}, {1, 4}, {2, 8}});
  REQUIRE_THROWS_WITH(associate(by_line({0, 1, 2}, 3), numbered, 0.02),
                      Catch::Contains("frame 8") && Catch::Contains("3 lines"));
}

TEST_CASE("an empty trajectory is refused") {
  REQUIRE_THROWS_AS(associate(at_times({}), at_times({1.0}), 0.02), InputError);
  REQUIRE_THROWS_AS(associate(at_times({1.0}), at_times({}), 0.02), InputError);
}
