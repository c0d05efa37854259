// SPDX-License-Identifier: MIT
// Poses that a session has streamed out, put together again after later corrections.
#pragma once

#include <cstdint>
#include <vector>

#include "unisim/unisim.h"

namespace unisim::bench {

/// Keeps what unisim_next_retired() offers, as a host would that wants the whole trajectory.
class PoseBook {
 public:
  /// Take what has left the window since the last call.
  void read(unisim_session* session);
  /// Latest pose of a keyframe that has left the window. false: it was never offered, or its part
  /// of the map has been forgotten
  bool find(const unisim_session* session, int32_t keyframe, unisim_sim3* T_world_kf) const;

 private:
  struct Place {
    int32_t carrier = -1;  ///< submap, -1: none known
    unisim_sim3 T{};       ///< pose under it
  };
  static void put(std::vector<Place>* places, int32_t id, const Place& place);

  std::vector<Place> keyframes_;
  std::vector<Place> submaps_;  ///< those that hang on another one
};

}  // namespace unisim::bench
