// SPDX-License-Identifier: MIT
// Runs longer than the session remembers.
#include "drivers/pipeline/session_defaults.hpp"
#include "tests/pipeline/scripted_run.hpp"

using namespace unisim::testing;

TEST_CASE("a bounded run gives out every keyframe, and each has its pose at the end") {
  constexpr int32_t kKeyframes = 600;
  Run run(5 * kKeyframes);
  run.config.window_submaps = 2;
  run.config.max_keyframes = (2 + 9) * run.config.window_size;
  REQUIRE(run.go().outcome == Outcome::kFinished);
  const unisim_session_info info = run.info();
  CHECK(info.keyframes == kKeyframes);
  CHECK(info.retired_unread == 0);
  CHECK(run.listener.retired == info.retired_keyframes);
  REQUIRE(info.first_keyframe > 400);
  REQUIRE(info.retired_keyframes > 500);
  for (int32_t k = 0; k < info.retired_keyframes; ++k) {
    unisim_sim3 T{};
    REQUIRE(run.listener.book.find(run.pipeline->session(), k, &T));
    REQUIRE(Run::distance(T, run.predictor.keyframes[static_cast<size_t>(k)]) < 1e-5);
  }
}

TEST_CASE("capacity follows from the length of the sequence, of a sliding window it does not") {
  const Run run;
  KeyframeConfig keyframes;
  keyframes.stride = 5;
  CHECK(keyframe_capacity(run.config, 500, keyframes, 1024) >= 100);
  CHECK(keyframe_capacity(run.config, 500, keyframes, 1024) <= 102);
  CHECK(keyframe_capacity(run.config, -1, keyframes, 1024) == 1024);
  keyframes.stride = 0;
  keyframes.min_gap = 2;
  CHECK(keyframe_capacity(run.config, 500, keyframes, 1024) >= 250);
  unisim_config bounded = run.config;
  bounded.window_size = 32;
  for (const int32_t windows : {2, 8, 64}) {
    bounded.window_submaps = windows;
    bounded.max_keyframes = keyframe_capacity(bounded, 1000000, keyframes, 1024);
    CHECK(bounded.max_keyframes == keyframe_capacity(bounded, -1, keyframes, 1024));
    size_t bytes = 0;
    CHECK(unisim_arena_size(&bounded, &bytes) == UNISIM_OK);
  }
}
