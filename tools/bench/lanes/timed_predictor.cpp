// SPDX-License-Identifier: MIT
// A predictor of simulated predictions that takes as long for them as it is told.
#include "tools/bench/lanes/timed_predictor.hpp"

#include <chrono>
#include <thread>

#include "tools/bench/simulator/c_structs.hpp"

namespace unisim::bench {

namespace {

void compute_for(double seconds) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  while (Clock::now() < end) {
  }
}

}  // namespace

TimedPredictor::TimedPredictor(const simulator::World& world, uint64_t seed,
                               const PredictorTimes& times)
    : predictor_(world, seed), times_(times) {
  handle_.self = this;
  unisim_predictor& t = handle_.table;
  t.struct_size = sizeof t;
  t.name = "simulated";
  t.concurrent_windows = 1;
  t.observe = [](unisim_predictor*, const unisim_frame*, unisim_motion* motion) {
    *motion = {-1.0, -1.0, 0, 0};
    return UNISIM_PREDICTION_OK;
  };
  t.keyframe = [](unisim_predictor*, const unisim_frame*, int32_t) { return UNISIM_PREDICTION_OK; };
  t.two_view = [](unisim_predictor* p, int32_t i, int32_t, unisim_pair_prediction* out) {
    return self(p)->two_view(i, out);
  };
  t.multi_view = [](unisim_predictor* p, const int32_t* ids, int32_t count,
                    unisim_window_prediction* out) { return self(p)->multi_view(ids, count, out); };
  t.info = [](unisim_predictor*, unisim_predictor_info* out) {
    *out = {};
    out->initialised = 1;
  };
  t.message = [](unisim_predictor*) { return ""; };
  t.window_message = t.message;
  t.destroy = [](unisim_predictor*) {};
}

TimedPredictor* TimedPredictor::self(unisim_predictor* predictor) {
  return reinterpret_cast<Handle*>(predictor)->self;
}

void TimedPredictor::fill(Arrays* arrays) {
  arrays->poses.clear();
  arrays->maps.clear();
  for (const simulator::RigidPose& pose : arrays->prediction.T_local_kf) {
    arrays->poses.push_back(simulator::to_c(pose));
  }
  for (const simulator::DepthMap& depth : arrays->prediction.depth) {
    arrays->maps.push_back(simulator::to_c(depth));
  }
}

int TimedPredictor::two_view(int32_t i, unisim_pair_prediction* out) {
  compute_for(times_.pair_s);
  pair_.prediction = predictor_.pair(i);
  fill(&pair_);
  *out = {};
  out->T_i_j = pair_.poses[1];
  out->depth_i = pair_.maps[0];
  out->depth_j = pair_.maps[1];
  return UNISIM_PREDICTION_OK;
}

int TimedPredictor::multi_view(const int32_t* ids, int32_t count, unisim_window_prediction* out) {
  if (times_.busy) {
    compute_for(times_.window_s);
  } else {
    std::this_thread::sleep_for(std::chrono::duration<double>(times_.window_s));
  }
  window_.prediction = predictor_.window(ids[0], count);
  fill(&window_);
  *out = {};
  out->token = -1;
  out->count = count;
  out->keyframe_ids = window_.prediction.keyframes.data();
  out->T_window_kf = window_.poses.data();
  out->depth = window_.maps.data();
  return UNISIM_PREDICTION_OK;
}

}  // namespace unisim::bench
