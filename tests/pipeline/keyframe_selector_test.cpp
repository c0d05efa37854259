// SPDX-License-Identifier: MIT
// Which frames become keyframes.
#include "drivers/pipeline/keyframe_selector.hpp"

#include <vector>

#include "tests/support/catch.hpp"

using unisim::pipeline::KeyframeConfig;
using unisim::pipeline::KeyframeSelector;

namespace {

const unisim_motion kStill = {0.0, 1.0, 0, 0};

unisim_motion flow_of(double flow) { return {flow, 1.0, 0, 0}; }

std::vector<int64_t> chosen(KeyframeSelector* selector, const std::vector<int64_t>& frames,
                            const unisim_motion& motion) {
  std::vector<int64_t> out;
  for (const int64_t frame : frames) {
    if (selector->choose(frame, motion)) out.push_back(frame);
  }
  return out;
}

}  // namespace

TEST_CASE("a stride takes every N-th frame from the first one on") {
  KeyframeConfig config;
  config.stride = 3;
  KeyframeSelector selector(config);
  const std::vector<int64_t> frames = {7, 8, 9, 10, 11, 12, 13, 14};
  REQUIRE(chosen(&selector, frames, kStill) == std::vector<int64_t>{7, 10, 13});
}

TEST_CASE("a stride keeps its grid when a frame of it is missing") {
  KeyframeConfig config;
  config.stride = 3;
  KeyframeSelector selector(config);
  const std::vector<int64_t> frames = {0, 1, 2, 4, 5, 6, 7, 8, 9};
  REQUIRE(chosen(&selector, frames, kStill) == std::vector<int64_t>{0, 4, 6, 9});
}

TEST_CASE("a stride does not listen to the predictor's advice") {
  KeyframeConfig config;
  config.stride = 4;
  KeyframeSelector selector(config);
  REQUIRE(selector.choose(0, {0.0, 1.0, -1, 0}));
  REQUIRE_FALSE(selector.choose(1, {0.5, 0.1, 1, 0}));
  REQUIRE(selector.choose(4, {0.0, 1.0, -1, 0}));
}

TEST_CASE("by motion a frame is taken when the flow or the lost share says so") {
  KeyframeConfig config;
  config.flow = 0.03;
  config.tracked = 0.6;
  config.min_gap = 2;
  config.max_gap = 10;
  KeyframeSelector selector(config);
  REQUIRE(selector.choose(0, kStill));
  SECTION("enough flow, but not before the smallest gap") {
    REQUIRE_FALSE(selector.choose(1, flow_of(0.05)));
    REQUIRE(selector.choose(2, flow_of(0.05)));
  }
  SECTION("too little flow") { REQUIRE_FALSE(selector.choose(5, flow_of(0.029))); }
  SECTION("features out of sight") { REQUIRE(selector.choose(5, {0.0, 0.59, 0, 0})); }
  SECTION("nothing measured") { REQUIRE_FALSE(selector.choose(5, {-1.0, -1.0, 0, 0})); }
  SECTION("the largest gap") {
    REQUIRE_FALSE(selector.choose(9, kStill));
    REQUIRE(selector.choose(10, kStill));
  }
  SECTION("advice rules over all of it") {
    REQUIRE(selector.choose(1, {0.0, 1.0, 1, 0}));
    REQUIRE_FALSE(selector.choose(40, {0.9, 0.1, -1, 0}));
  }
}
