// SPDX-License-Identifier: MIT
// One run of the pipeline on the scripted world, with everything a test may want to change.
#pragma once

#include <atomic>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "drivers/pipeline/pipeline.hpp"
#include "drivers/pipeline/pose_book.hpp"
#include "tests/pipeline/scripted_world.hpp"
#include "tests/support/catch.hpp"

namespace unisim::testing {

using namespace unisim::pipeline;

/// Keeps what it is told.
class Recorder : public Listener {
 public:
  void on_message(const std::string& line) override { lines.push_back(line); }
  void on_window(int32_t, const unisim_window_prediction&) override { ++windows; }
  void on_revision(int32_t, const unisim_window_revision&) override { ++revisions; }
  void on_live_pose(const LivePose& pose) override { live.push_back(pose); }
  void on_keyframe_pose(const unisim_pose& pose) override { posed.push_back(pose); }
  void on_between_pose(const BetweenPose& pose) override { between.push_back(pose); }
  void on_place(const unisim_place_report& look) override { places.push_back(look); }
  void on_retired(const unisim_retired& one, const unisim_pose*) override {
    retired += one.kind == UNISIM_RETIRED_KEYFRAME ? 1 : 0;
    book.take(one);
  }

  bool told(const std::string& part) const {
    for (const std::string& line : lines) {
      if (line.find(part) != std::string::npos) return true;
    }
    return false;
  }

  std::vector<std::string> lines;
  int windows = 0;
  int revisions = 0;
  int retired = 0;
  std::vector<LivePose> live;
  std::vector<unisim_pose> posed;  // keyframes
  std::vector<BetweenPose> between;
  std::vector<unisim_place_report> places;
  PoseBook book;
};

/// One run of 200 frames at stride 5 with everything a test may want to change.
struct Run {
  explicit Run(int64_t frames = 200) : source(frames) {
    REQUIRE(unisim_config_init(&config, sizeof config) == UNISIM_OK);
    config.max_keyframes = 64;
    config.window_size = 8;
    config.live_scale_exponent = 1.0;
    options.keyframes.stride = 5;
  }

  const Result& go() {
    pipeline = std::make_unique<Pipeline>(options, source.table(), predictor.table(), config,
                                          listeners, &stop);
    return pipeline->run();
  }

  unisim_session_info info() const {
    unisim_session_info out{};
    out.struct_size = sizeof out;
    REQUIRE(unisim_get_info(pipeline->session(), &out) == UNISIM_OK);
    return out;
  }

  unisim_pose pose(int32_t keyframe) const {
    unisim_pose out{};
    out.struct_size = sizeof out;
    REQUIRE(unisim_get_pose(pipeline->session(), keyframe, &out) == UNISIM_OK);
    return out;
  }

  /// Largest distance of a keyframe from the truth, in true units.
  double worst_error() const {
    double worst = 0.0;
    for (size_t k = 0; k < predictor.keyframes.size(); ++k) {
      const unisim_sim3 T = pose(static_cast<int32_t>(k)).T_world_kf;
      worst = std::max(worst, distance(T, predictor.keyframes[k]));
    }
    return worst;
  }

  /// The world is in the unit of the first pair.
  static double distance(const unisim_sim3& T, int64_t frame) {
    const unisim_sim3 truth = true_pose(frame);
    double sum = 0.0;
    for (int k = 0; k < 3; ++k) {
      sum += std::pow(T.t[k] / ScriptedPredictor::pair_unit(0) - truth.t[k], 2);
    }
    return std::sqrt(sum);
  }

  ScriptedSource source;
  ScriptedPredictor predictor;
  unisim_config config;
  Options options;
  std::atomic<bool> stop{false};
  Recorder listener;
  std::vector<Listener*> listeners{&listener};
  std::unique_ptr<Pipeline> pipeline;
};

}  // namespace unisim::testing
