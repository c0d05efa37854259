// SPDX-License-Identifier: MIT
// Percentiles of durations in constant memory.
#include "drivers/pipeline/latency_histogram.hpp"

#include "tests/support/catch.hpp"

using unisim::pipeline::LatencyHistogram;

TEST_CASE("percentiles are right to the width of a bucket and the maximum exactly") {
  LatencyHistogram histogram;
  for (int k = 1; k <= 1000; ++k) histogram.add_ms(0.1 * k);
  REQUIRE(histogram.count() == 1000);
  CHECK(histogram.percentile_ms(0.5) == Approx(50.0).epsilon(0.026));
  CHECK(histogram.percentile_ms(0.95) == Approx(95.0).epsilon(0.026));
  CHECK(histogram.max_ms() == 100.0);
}

TEST_CASE("a percentile never exceeds the maximum") {
  LatencyHistogram histogram;
  histogram.add_ms(1.0);
  CHECK(histogram.percentile_ms(0.95) <= 1.0);
  CHECK(histogram.percentile_ms(0.95) == Approx(1.0).epsilon(0.026));
}

TEST_CASE("no durations give zeros, absurd ones do no harm") {
  LatencyHistogram histogram;
  CHECK(histogram.percentile_ms(0.5) == 0.0);
  histogram.add_ms(0.0);
  histogram.add_ms(1e9);
  CHECK(histogram.count() == 2);
  CHECK(histogram.percentile_ms(0.5) <= 0.001);
  CHECK(histogram.max_ms() == 1e9);
}
