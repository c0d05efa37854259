// SPDX-License-Identifier: MIT
// Poses that a session has streamed out, put together again after later corrections.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/pipeline/temporary_file.hpp"
#include "unisim/unisim.h"

namespace unisim::pipeline {

/// Keeps what unisim_next_retired() offers, for a host that wants the whole trajectory.
class PoseBook {
 public:
  /// @param folder where its pages lie, "" for memory
  explicit PoseBook(const std::string& folder = "") : keyframes_(folder), submaps_(folder) {}

  void take(const unisim_retired& retired);

  /// Latest pose of a keyframe that has left the window. false: it was never offered, or its part
  /// of the map has been forgotten
  bool find(const unisim_session* session, int32_t keyframe, unisim_sim3* T_world_kf) const;

  /// Latest pose of a submap, kept by the session or not. false: as for keyframes
  bool find_submap(const unisim_session* session, int32_t submap,
                   unisim_sim3* T_world_submap) const;

 private:
  struct Place {
    int32_t carrier = -1;  ///< submap, -1: none known
    unisim_sim3 T{};       ///< pose under it
  };

  RecordFile<Place> keyframes_;
  RecordFile<Place> submaps_;  ///< those that hang on another one
};

}  // namespace unisim::pipeline
