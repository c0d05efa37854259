// SPDX-License-Identifier: MIT
// A predictor of simulated predictions that takes as long for them as it is told.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/predictor.h"
#include "tools/bench/simulator/predictor.hpp"

namespace unisim::bench {

struct PredictorTimes {
  double pair_s = 0.0;    ///< computing
  double window_s = 0.0;  ///< waiting, or computing with `busy`
  bool busy = false;
};

/// Answers windows beside the pairs (concurrent_windows).
class TimedPredictor {
 public:
  TimedPredictor(const simulator::World& world, uint64_t seed, const PredictorTimes& times);
  unisim_predictor* table() { return &handle_.table; }

 private:
  struct Handle {
    unisim_predictor table;
    TimedPredictor* self;
  };
  /// Of one answer.
  struct Arrays {
    simulator::Prediction prediction;
    std::vector<unisim_sim3> poses;
    std::vector<unisim_depth_map> maps;
  };
  static TimedPredictor* self(unisim_predictor* predictor);
  static void fill(Arrays* arrays);
  int two_view(int32_t i, unisim_pair_prediction* out);
  int multi_view(const int32_t* ids, int32_t count, unisim_window_prediction* out);

  Handle handle_{};
  simulator::Predictor predictor_;
  PredictorTimes times_;
  Arrays pair_;
  Arrays window_;
};

}  // namespace unisim::bench
