// SPDX-License-Identifier: MIT
// Local scale, thinning, ticks: the arithmetic behind the charts.
#include <cmath>

#include "tests/support/catch.hpp"
#include "tools/replay/report/axis.hpp"
#include "tools/replay/report/chart.hpp"
#include "tools/replay/report/local_scale.hpp"
#include "tools/replay/report/text.hpp"

using namespace unisim::report;

namespace {

std::vector<Point> walk(int count, double late_scale) {
  std::vector<Point> points;
  double x = 0.0;
  for (int k = 0; k < count; ++k) {
    x += k < count / 2 ? 1.0 : late_scale;
    points.push_back({0.1 * k, x, -x, 0.5 * x, 0});
  }
  return points;
}

}  // namespace

TEST_CASE("local scale finds a piece of another size") {
  const std::vector<Sample> scale = local_scale(walk(100, 1.25), walk(100, 1.0), 5);
  REQUIRE(scale.size() == 90);
  CHECK(scale.front().value == Approx(1.0));
  CHECK(scale.back().value == Approx(1.25));
  CHECK(scale.front().time_s == Approx(0.5));
}

TEST_CASE("local scale leaves out rest and the seam of two segments") {
  std::vector<Point> truth = walk(100, 0.0);
  CHECK(local_scale(truth, truth, 5).size() < 60);
  std::vector<Point> estimate = walk(100, 1.0);
  for (size_t k = 50; k < estimate.size(); ++k) estimate[k].segment = 1;
  CHECK(local_scale(estimate, walk(100, 1.0), 5).size() == 80);
  CHECK(local_scale(walk(10, 1.0), walk(10, 1.0), 5).empty());
}

TEST_CASE("thinning keeps the extremes and their order") {
  std::vector<Sample> samples;
  for (int k = 0; k < 10000; ++k) samples.push_back({0.01 * k, std::sin(0.01 * k), 0});
  samples[1234].value = 7.0;
  samples[4321].value = -7.0;
  const std::vector<Sample> thin = thinned(samples, 500);
  CHECK(thin.size() <= 500);
  double highest = 0.0;
  double lowest = 0.0;
  for (size_t k = 0; k < thin.size(); ++k) {
    highest = std::max(highest, thin[k].value);
    lowest = std::min(lowest, thin[k].value);
    if (k > 0) REQUIRE(thin[k].time_s > thin[k - 1].time_s);
  }
  CHECK(highest == 7.0);
  CHECK(lowest == -7.0);
}

TEST_CASE("ticks are at round numbers and labelled with enough decimals") {
  CHECK(tick_step(0.0, 10.0, 5) == Approx(2.0));
  CHECK(tick_step(0.0, 0.03, 5) == Approx(0.01));
  CHECK(tick_step(0.0, 0.021, 5) == Approx(0.005));
  CHECK(ticks(-0.25, 0.25, 0.1).size() == 5);
  CHECK(tick_label(0.30000000000000004, 0.1) == "0.3");
  CHECK(tick_label(-1e-17, 0.1) == "0.0");
  CHECK(tick_label(1500.0, 500.0) == "1500");
  CHECK(tick_label(0.005, 0.005) == "0.005");
}

TEST_CASE("coordinates are short") {
  CHECK(coordinate(1.5) == "1.5");
  CHECK(coordinate(2.0) == "2");
  CHECK(coordinate(100.0) == "100");
  CHECK(coordinate(-0.001) == "0");
}
