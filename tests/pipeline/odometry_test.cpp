// SPDX-License-Identifier: MIT
// Odometry: files, times between, and the scale that a run gets from them.
#include "drivers/pipeline/odometry.hpp"

#include <cmath>

#include "drivers/sequence/text_file.hpp"
#include "tests/pipeline/scripted_run.hpp"
#include "tests/support/temp_folder.hpp"

using namespace unisim::testing;

namespace {

constexpr double kMetre = 0.7;  // metres in a length of the scripted world

std::string problem_of(const std::string& text) {
  const TempFolder folder;
  try {
    static_cast<void>(Odometry::read(folder.write("odometry.txt", text)));
  } catch (const unisim::sequence::InputError& error) {
    return error.what();
  }
  return "";
}

Odometry odometry_of(const std::string& text) {
  const TempFolder folder;
  return Odometry::read(folder.write("odometry.txt", text));
}

/// What an exact odometer says of the scripted camera, 30 times a second.
Odometry exact_odometry(int64_t frames, bool positions) {
  std::string text = "# exact\n";
  double path = 0.0;
  for (int64_t k = 0; k < frames; ++k) {
    const unisim_sim3 T = true_pose(k);
    if (k > 0) {
      const unisim_sim3 before = true_pose(k - 1);
      path +=
          kMetre * std::sqrt(std::pow(T.t[0] - before.t[0], 2) + std::pow(T.t[1] - before.t[1], 2) +
                             std::pow(T.t[2] - before.t[2], 2));
    }
    char line[256];
    std::snprintf(line, sizeof line, "%.9f %.12g", static_cast<double>(k) / 30.0, path);
    if (positions) {
      std::snprintf(line, sizeof line, "%.9f %.12g %.12g %.12g", static_cast<double>(k) / 30.0,
                    kMetre * T.t[0], kMetre * T.t[1], kMetre * T.t[2]);
    }
    text += std::string(line) + "\n";
  }
  return odometry_of(text);
}

unisim_scale scale_of(const Run& run) {
  unisim_scale scale{};
  scale.struct_size = sizeof scale;
  REQUIRE(unisim_get_scale(run.pipeline->session(), 0, &scale) == UNISIM_OK);
  return scale;
}

}  // namespace

TEST_CASE("odometry between two entries lies on the line between them") {
  const Odometry odometry = odometry_of("10 1 2 3\n10.5 3 2 3\n11 3 4 3\n");
  Travelled there;
  REQUIRE(odometry.at(10250000000, &there));
  CHECK(there.position[0] == Approx(2.0));
  CHECK(there.path == Approx(1.0));
  REQUIRE(odometry.at(11000000000, &there));
  CHECK(there.position[1] == Approx(4.0));
  CHECK(there.path == Approx(4.0));
  CHECK(odometry.has_positions());
}

TEST_CASE("outside of its entries and in a long gap odometry says nothing") {
  const Odometry odometry = odometry_of("10 1\n11 2\n15 3\n");
  Travelled there;
  CHECK_FALSE(odometry.at(9999999999, &there));
  CHECK_FALSE(odometry.at(12000000000, &there));
  CHECK_FALSE(odometry.at(15000000001, &there));
  CHECK(odometry.at(10500000000, &there));
  CHECK(there.path == Approx(1.5));
  CHECK_FALSE(odometry.has_positions());
}

TEST_CASE("TUM poses are positions") {
  const Odometry odometry = odometry_of("# t x y z q\n1 1 0 0 0 0 0 1\n2 1 2 0 0 0 0 1\n");
  Travelled there;
  REQUIRE(odometry.at(2000000000, &there));
  CHECK(there.path == Approx(2.0));
}

TEST_CASE("a file that is no odometry is refused with its line") {
  const auto contains = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  CHECK(contains(problem_of("1 2\n1 3\n"), "odometry.txt:2: time does not grow"));
  CHECK(contains(problem_of("1 2\n2 3 4\n"), ":2: not as many numbers"));
  CHECK(contains(problem_of("1 2\n2 x\n"), ":2: \"x\" is no number"));
  CHECK(contains(problem_of("1 2\n2 nan\n"), ":2: \"nan\" is no number"));
  CHECK(contains(problem_of("1 2 3 4 5\n2 2 3 4 5\n"), ":1: 5 numbers"));
  CHECK(contains(problem_of("1\n2\n"), ":1: 1 numbers"));
  CHECK(contains(problem_of("1 2\n"), "fewer than two lines"));
  CHECK(contains(problem_of(""), "fewer than two lines"));
}

TEST_CASE("a run with odometry knows its scale") {
  const bool positions = GENERATE(true, false);
  Run run(300);
  const Odometry odometry = exact_odometry(300, positions);
  run.options.odometry = {&odometry, 0.02};
  REQUIRE(run.go().outcome == Outcome::kFinished);
  const unisim_scale scale = scale_of(run);
  const double expected = kMetre / ScriptedPredictor::pair_unit(0);
  CHECK(std::abs(std::log(scale.metres_per_unit / expected)) < (positions ? 1e-3 : 0.02));
  CHECK(scale.taken > 8);
  CHECK(scale.sigma < 0.02);
}

TEST_CASE("positions that come while the run goes make it metric, however they jitter") {
  Run run(300);
  DistanceInbox inbox;
  run.options.odometry = {nullptr, 0.02, 0.0, &inbox};
  run.source.before_frame = [&](int64_t frame) {
    const unisim_sim3 T = true_pose(frame);
    // The odometer jitters: its path is longer than the way, its chords are not.
    const double jitter = frame % 2 == 0 ? 0.01 : -0.01;
    REQUIRE(
        inbox.add(OdometryPosition{frame * 33333333,
                                   {kMetre * T.t[0], kMetre * T.t[1] + jitter, kMetre * T.t[2]}},
                  0.0));
  };
  REQUIRE(run.go().outcome == Outcome::kFinished);
  const unisim_scale scale = scale_of(run);
  const double expected = kMetre / ScriptedPredictor::pair_unit(0);
  CHECK(std::abs(std::log(scale.metres_per_unit / expected)) < 0.01);
  CHECK(scale.taken > 8);
}

TEST_CASE("positions come in the order of time, and an odometer that is set back begins anew") {
  DistanceInbox inbox;
  CHECK(inbox.add(OdometryPosition{1000000000, {5, 0, 0}}, 0.0));
  CHECK_FALSE(inbox.add(OdometryPosition{1000000000, {6, 0, 0}}, 0.0));
  Odometry odometry;
  odometry.add(OdometryPosition{1000000000, {500, 0, 0}});
  odometry.add(OdometryPosition{1100000000, {501, 0, 0}});
  odometry.add(OdometryPosition{1200000000, {0, 0, 0}});
  odometry.add(OdometryPosition{1300000000, {1, 0, 0}});
  Travelled before;
  Travelled after;
  Travelled between;
  REQUIRE(odometry.at(1050000000, &before));
  REQUIRE(odometry.at(1250000000, &after));
  CHECK(before.position[0] == Approx(500.5));
  CHECK(after.position[0] == Approx(0.5));
  CHECK(before.stretch != after.stretch);
  CHECK_FALSE(odometry.at(1150000000, &between));
}

TEST_CASE("without odometry no distance is made") {
  Run run(300);
  REQUIRE(run.go().outcome == Outcome::kFinished);
  unisim_scale scale{};
  scale.struct_size = sizeof scale;
  CHECK(unisim_get_scale(run.pipeline->session(), 0, &scale) == UNISIM_ERR_NOT_READY);
}

TEST_CASE("a predictor that says metres makes the run metric") {
  Run run(200);
  run.predictor.metres = kMetre;
  REQUIRE(run.go().outcome == Outcome::kFinished);
  const unisim_scale scale = scale_of(run);
  CHECK(scale.metres_per_unit == Approx(kMetre / ScriptedPredictor::pair_unit(0)).epsilon(1e-5));
  CHECK(scale.sigma >= 0.05);
  CHECK(scale.sigma < 0.1);
}
