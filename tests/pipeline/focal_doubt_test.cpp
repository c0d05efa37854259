// SPDX-License-Identifier: MIT
// A focal length that is hardly known is told, while a run goes on and at its end.
#include "drivers/pipeline/focal_doubt.hpp"

#include <algorithm>
#include <string>

#include "tests/pipeline/scripted_run.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::testing;

namespace {

const char* const kStart = "focal length 500 px is uncertain by ";

int64_t doubts(const Recorder& listener) {
  return std::count_if(listener.lines.begin(), listener.lines.end(),
                       [](const std::string& line) { return line.find(kStart) == 0; });
}

}  // namespace

TEST_CASE("an uncertain focal length is told with how uncertain it is") {
  unisim_predictor_info info{};
  info.focal_px = 500.0;
  info.focal_sigma_px = 120.0;
  CHECK(focal_doubt(info).find("focal length 500 px is uncertain by 24 %") == 0);
  info.focal_sigma_px = 30.0;
  CHECK(focal_doubt(info).empty());
  info.focal_px = 0.0;
  info.focal_sigma_px = 0.0;
  CHECK(focal_doubt(info).empty());
}

TEST_CASE("a short run tells it at its end") {
  Run run;
  run.predictor.focal_sigma_px = 120.0;
  run.go();
  CHECK(doubts(run.listener) == 1);
}

TEST_CASE("a long run tells it on the way too, not at each keyframe") {
  Run run(500);
  run.config.max_keyframes = 128;
  run.predictor.focal_sigma_px = 120.0;
  run.go();
  CHECK(doubts(run.listener) == 2);
}

TEST_CASE("a focal length that is given or known is not remarked on") {
  Run run;
  run.predictor.focal_sigma_px = GENERATE(0.0, 10.0);
  run.go();
  CHECK(doubts(run.listener) == 0);
}
