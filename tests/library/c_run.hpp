// SPDX-License-Identifier: MIT
// A run behind the C header on the scripted world, and what its callbacks told.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "drivers/library/pipeline.h"
#include "tests/pipeline/scripted_world.hpp"
#include "tests/support/catch.hpp"

namespace unisim::testing {

/// What the callbacks of a run told.
struct Told {
  std::vector<unisim_live_pose> poses;
  std::vector<unisim_correction> corrections;
  std::vector<unisim_pose> keyframes;
  std::vector<int32_t> states;
  std::vector<std::string> lines;
  // Asks the run to end at the tenth pose.
  std::atomic<unisim_pipeline*>* stops_after_pose = nullptr;
};

inline Told* of(void* user) { return static_cast<Told*>(user); }

/// A scripted run of 200 frames, every fifth a keyframe.
struct CRun {
  explicit CRun(int64_t frames = 200) : source(frames) {
    unisim_pipeline_config_init(&config, sizeof config);
    REQUIRE(unisim_config_init(&session, sizeof session) == UNISIM_OK);
    session.max_keyframes = 64;
    session.window_size = 8;
    config.session = &session;
    config.source = source.table();
    config.predictor = predictor.table();
    config.stride = 5;
    config.user = &told;
    config.on_pose = [](const unisim_live_pose* pose, void* user) {
      of(user)->poses.push_back(*pose);
      if (of(user)->stops_after_pose != nullptr && of(user)->poses.size() == 10) {
        unisim_pipeline_ask_stop(of(user)->stops_after_pose->load());
      }
    };
    config.on_correction = [](const unisim_correction* one, void* user) {
      of(user)->corrections.push_back(*one);
    };
    config.on_keyframe = [](const unisim_pose* pose, void* user) {
      of(user)->keyframes.push_back(*pose);
    };
    config.on_state = [](int32_t state, void* user) { of(user)->states.push_back(state); };
    config.on_message = [](const char* line, void* user) { of(user)->lines.emplace_back(line); };
  }

  unisim_pipeline* start() { return unisim_pipeline_start(&config, message, sizeof message); }

  ScriptedSource source;
  ScriptedPredictor predictor;
  unisim_config session{};
  unisim_pipeline_config config{};
  Told told;
  char message[256] = "";
};

inline int wait_for_end(unisim_pipeline* pipeline) {
  int how = UNISIM_PIPELINE_RUNS;
  while (how == UNISIM_PIPELINE_RUNS) how = unisim_pipeline_poll(pipeline, 1000);
  return how;
}

}  // namespace unisim::testing
