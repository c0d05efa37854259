// SPDX-License-Identifier: MIT
// Times as text: every digit kept, units told apart.
#include "drivers/sequence/time_text.hpp"

#include "drivers/sequence/pose_file.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temp_folder.hpp"

using namespace unisim::sequence;

namespace {

int64_t nanoseconds(const char* text, TimeUnit unit) {
  int64_t ns = -1;
  INFO(text);
  REQUIRE(parse_time(text, unit, &ns));
  return ns;
}

TimeUnit list_unit(const std::vector<double>& times, TimeUnit own) {
  return guess_unit(times, own, kLongestImageStepS);
}

}  // namespace

TEST_CASE("times are read exactly, by whole numbers alone") {
  const auto seconds = TimeUnit::kSeconds;
  REQUIRE(nanoseconds("1305031102.175304123", seconds) == 1305031102175304123);
  REQUIRE(nanoseconds("1.305031102175304e+09", seconds) == 1305031102175304000);
  REQUIRE(nanoseconds("2.2e-1", seconds) == 220000000);
  REQUIRE(nanoseconds("-0.5", seconds) == -500000000);
  REQUIRE(nanoseconds("+7", seconds) == 7000000000);
  REQUIRE(nanoseconds("000.1", seconds) == 100000000);
  REQUIRE(nanoseconds("0.0000000005", seconds) == 1);
  REQUIRE(nanoseconds("0.00000000049", seconds) == 0);
  REQUIRE(nanoseconds("0.00000000005", seconds) == 0);
  REQUIRE(nanoseconds("0e300", seconds) == 0);
  REQUIRE(nanoseconds("1403715273262142976", TimeUnit::kNanoseconds) == 1403715273262142976);
  REQUIRE(nanoseconds("1403715274312143104.0", TimeUnit::kNanoseconds) == 1403715274312143104);
  REQUIRE(nanoseconds("1403715273262142.976", TimeUnit::kMicroseconds) == 1403715273262142976);
  REQUIRE(nanoseconds("33.333", TimeUnit::kMilliseconds) == 33333000);
  int64_t ns = 0;
  for (const char* text : {"", "+", "-", ".", "nan", "inf", "1e30", "9300000000", "12a", "1,5",
                           "1.2.3", "1e", "--1"}) {
    INFO(text);
    REQUIRE_FALSE(parse_time(text, seconds, &ns));
  }
}

TEST_CASE("the unit of a list is told by its steps and its largest value") {
  const auto own = GENERATE(TimeUnit::kSeconds, TimeUnit::kNanoseconds);
  const auto start = GENERATE(0.0, 1.4e9);  // seconds
  const auto unit = GENERATE(TimeUnit::kSeconds, TimeUnit::kMilliseconds, TimeUnit::kMicroseconds,
                             TimeUnit::kNanoseconds);
  const auto rate = GENERATE(10.0, 30.0);
  std::vector<double> times;
  for (int k = 0; k < 20; ++k) times.push_back((start + k / rate) * units_per_second(unit));
  INFO(unit_name(own) << ", " << unit_name(unit) << ", from " << start << ", " << rate << " Hz");
  REQUIRE(list_unit(times, own) == unit);
}

TEST_CASE("the unit of the format is kept where it is possible") {
  REQUIRE(list_unit({1, 2, 3}, TimeUnit::kSeconds) == TimeUnit::kSeconds);
  REQUIRE(list_unit({5}, TimeUnit::kNanoseconds) == TimeUnit::kNanoseconds);
  REQUIRE(list_unit({}, TimeUnit::kNanoseconds) == TimeUnit::kNanoseconds);
  REQUIRE(list_unit({1.4e9, 1.4e9 + 60, 1.4e9 + 120}, TimeUnit::kSeconds) == TimeUnit::kSeconds);
  // A pause is no step.
  REQUIRE(list_unit({0, 0.1, 0.2, 900, 900.1}, TimeUnit::kSeconds) == TimeUnit::kSeconds);
  // Poses may be stamped with frame numbers.
  REQUIRE(guess_unit({0, 30, 60}, TimeUnit::kSeconds, kLongestPoseStepS) == TimeUnit::kSeconds);
}

TEST_CASE("pose files in another unit are read in it, and it is told") {
  const TempFolder folder;
  const PoseFile tum = read_pose_file(folder.write(
      "a.txt", "1400000000000000000 1 2 3 0 0 0 1\n1400000000050000000 1 2 3 0 0 0 1\n"));
  REQUIRE(tum.foreign_unit);
  REQUIRE(tum.unit == TimeUnit::kNanoseconds);
  REQUIRE(tum.poses[1].timestamp_ns == 1400000000050000000);
  REQUIRE(tum.poses[1].time_s == 1400000000.05);
  const PoseFile euroc = read_pose_file(folder.write(
      "b.csv", "1400000000.00,1,2,3,1,0,0,0,0,0,0\n1400000000.05,1,2,3,1,0,0,0,0,0,0\n"));
  REQUIRE(euroc.foreign_unit);
  REQUIRE(euroc.poses[1].timestamp_ns == 1400000000050000000);
}
