// SPDX-License-Identifier: MIT
// A simulated walk through a session.
#include "tools/bench/walk/walk_run.hpp"

#include <algorithm>
#include <cmath>

#include "tools/bench/process.hpp"
#include "tools/bench/simulator/predictor.hpp"
#include "tools/bench/walk/walk_session.hpp"
#include "tools/common/failure.hpp"
#include "tools/eval/alignment.hpp"

namespace unisim::bench {
namespace {

using Positions = std::vector<Eigen::Vector3d>;

constexpr int32_t kFinalIterations = 50;

unisim_config config_for(const WalkSettings& settings, size_t loops) {
  unisim_config config{};
  if (unisim_config_init(&config, sizeof config) != UNISIM_OK) {
    throw tools::Failure(tools::kExitOther, "unisim_config_init failed: rebuild the program");
  }
  const bool bounded = settings.window_submaps > 0 && settings.readable > 0;
  config.max_keyframes = bounded ? settings.readable : settings.keyframes;
  if (settings.window_submaps == 0) config.max_loops = static_cast<int32_t>(loops);
  config.window_submaps = settings.window_submaps;
  config.skeleton_capacity = settings.skeleton_capacity;
  config.window_overlap = settings.overlap;
  config.preset = settings.preset;
  config.disabled_factors = settings.disabled_factors;
  config.depth_grid_width = simulator::kDepthWidth;
  config.depth_grid_height = simulator::kDepthHeight;
  return config;
}

/// The model's noise and what was asked for on top.
simulator::NoiseModel noise_of(const WalkSettings& settings) {
  simulator::NoiseModel model;
  for (double* view : {&model.pair_view, &model.window_view})
    *view = std::hypot(*view, settings.scale_noise);
  model.pixel = std::hypot(model.pixel, settings.depth_noise);
  model.holes = settings.holes;
  return model;
}

double ate(const Positions& estimate, const Positions& truth) {
  const eval::Similarity T = eval::align(estimate, truth, eval::Alignment::kSim3);
  double sum = 0.0;
  for (size_t k = 0; k < truth.size(); ++k) sum += (T * estimate[k] - truth[k]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(truth.size()));
}

// Feeds one walk to one session.
class Walker {
 public:
  Walker(const WalkSettings& settings, const simulator::World& world,
         const std::vector<simulator::Loop>& loops, const pipeline::HeapWatch& heap)
      : settings_(settings),
        world_(world),
        loops_(loops),
        predictor_(world, settings.seed, noise_of(settings)),
        session_(config_for(settings, loops.size()), heap) {}

  WalkResult walk();

 private:
  template <class Add>
  void update(std::vector<double>* times, Add add);
  void step(int32_t keyframe);
  void take_windows();
  void take_loops(int32_t keyframe);
  Positions positions() const;

  const WalkSettings& settings_;
  const simulator::World& world_;
  const std::vector<simulator::Loop>& loops_;
  simulator::Predictor predictor_;
  WalkSession session_;
  size_t next_loop_ = 0;
  Positions live_;
  WalkResult result_;
};

template <class Add>
void Walker::update(std::vector<double>* times, Add add) {
  const double start = process_cpu_ms();
  add();
  session_.optimize(settings_.iterations);
  times->push_back(process_cpu_ms() - start);
}

void Walker::take_windows() {
  int32_t first = 0;
  int32_t count = 0;
  while (settings_.submaps && session_.next_window(&first, &count)) {
    const simulator::Prediction window = predictor_.window(first, count);
    update(&result_.update_ms, [&] { session_.add_window(window); });
    session_.read_retired();
  }
}

void Walker::take_loops(int32_t keyframe) {
  for (; next_loop_ < loops_.size(); ++next_loop_) {
    const simulator::Loop& next = loops_[next_loop_];
    const int32_t last =
        simulator::Loop::first_around(next.query, settings_.keyframes) + simulator::kLoopHalf - 1;
    if (last > keyframe) return;
    const simulator::Prediction loop = predictor_.loop(next);
    bool taken = true;
    update(&result_.loop_update_ms, [&] { taken = session_.add_loop(loop); });
    if (!taken) ++result_.loops_out_of_reach;
  }
}

void Walker::step(int32_t keyframe) {
  session_.add_keyframe();
  if (keyframe == 0) return;
  session_.add_pair(predictor_.pair(keyframe - 1));
  if (keyframe == 1) live_.push_back(session_.position(0));
  live_.push_back(session_.position(keyframe));
  take_windows();
  take_loops(keyframe);
}

Positions Walker::positions() const {
  Positions positions;
  for (int32_t k = 0; k < settings_.keyframes; ++k) positions.push_back(session_.position(k));
  return positions;
}

WalkResult Walker::walk() {
  for (int32_t k = 0; k < settings_.keyframes; ++k) step(k);
  if (session_.close_window()) take_windows();
  session_.optimize(kFinalIterations);
  session_.read_retired();

  Positions truth;
  for (const simulator::RigidPose& T : world_.T_world_kf) truth.push_back(T.t);
  const unisim_session_info info = session_.info();
  result_.keyframes = info.keyframes;
  result_.submaps = info.submaps;
  result_.submaps_refused = info.submaps_refused;
  result_.loops = info.loops;
  result_.loops_refused = info.loops_refused;
  result_.loop_suspensions = info.loop_suspensions;
  result_.loop_returns = info.loop_returns;
  result_.loops_dropped = info.loops_dropped;
  result_.arena_bytes = session_.arena_bytes();
  result_.depth_bytes = session_.depth_bytes();
  result_.snapshot = session_.snapshot();
  result_.live_ate_m = ate(live_, truth);
  result_.ate_m = ate(positions(), truth);
  return result_;
}

}  // namespace

WalkResult run_walk(const WalkSettings& settings, const pipeline::HeapWatch& heap) {
  const simulator::World world =
      simulator::make_world(settings.world, settings.keyframes, settings.seed);
  std::vector<simulator::Loop> loops;
  if (settings.loops) {
    loops = simulator::with_false_loops(world, simulator::find_loops(world), settings.false_loops,
                                        settings.seed);
  }
  const int64_t before = heap.calls();
  WalkResult result = Walker(settings, world, loops, heap).walk();
  result.heap_calls = heap.calls() - before;
  if (settings.window_submaps == 0) {
    result.ate_over_batch = 1.0;
  } else if (settings.batch) {
    WalkSettings batch = settings;
    batch.window_submaps = 0;
    result.ate_over_batch = result.ate_m / Walker(batch, world, loops, {}).walk().ate_m;
  }
  return result;
}

}  // namespace unisim::bench
