// SPDX-License-Identifier: MIT
// A network as the bench simulates it: pairs and windows that drift, descriptors and predictions of
// places seen again. A test may let places look alike, or let the network take one for another.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <set>
#include <vector>

#include "drivers/predictor.h"
#include "tools/bench/simulator/predictor.hpp"
#include "tools/bench/simulator/world.hpp"

namespace unisim::testing {

class WalkPredictor {
 public:
  WalkPredictor(const simulator::World& world, uint64_t seed);

  unisim_predictor* table() { return &handle_.table; }

  static constexpr int32_t kDimension = 256;

  /// Keyframes [from, to) stand for those `back` before them.
  struct Twin {
    int32_t from = 0;
    int32_t to = 0;
    int32_t back = 0;
  };
  Twin look;  ///< only in their descriptors
  Twin lie;   ///< in descriptors, and in where predictions of distant keyframes put them
  std::map<int32_t, int32_t> wrong_size;  ///< numbers in the descriptor of a keyframe
  std::set<int32_t> blank;                ///< keyframes whose descriptor is all zero

  int32_t kept() const;           ///< places now
  int32_t most_kept() const;      ///< at once
  int32_t calls_astray() const;   ///< for keyframes that were not kept, or out of their order
  int64_t distant_asked() const;  ///< predictions of keyframes that are not neighbours

 private:
  struct Handle {
    unisim_predictor table;
    WalkPredictor* self;
  };
  struct Arrays {
    std::vector<int32_t> ids;
    std::vector<unisim_sim3> poses;
    std::vector<simulator::DepthMap> depths;
    std::vector<unisim_depth_map> maps;
  };
  static WalkPredictor* self(unisim_predictor* predictor);
  int keyframe(int32_t id);
  int two_view(int32_t i, int32_t j, unisim_pair_prediction* out);
  int multi_view(const int32_t* ids, int32_t count, unisim_window_prediction* out);
  int describe(int32_t id, unisim_place_descriptor* out);
  void release(int32_t id);
  simulator::Prediction distant(const std::vector<int32_t>& ids) const;
  void fill(const simulator::Prediction& prediction, Arrays* arrays) const;

  Handle handle_{};
  const simulator::World& world_;
  simulator::Predictor predictor_;
  uint64_t seed_;
  mutable std::mutex mutex_;  // of what follows
  std::set<int32_t> places_;
  int32_t newest_ = -1;
  int32_t most_kept_ = 0;
  int32_t astray_ = 0;
  int64_t distant_asked_ = 0;
  Arrays pair_, window_;
  std::vector<int8_t> descriptor_;
};

}  // namespace unisim::testing
