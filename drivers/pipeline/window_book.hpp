// SPDX-License-Identifier: MIT
// Which submap a window of the predictor became, so that the predictor can measure it again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/mapfile/sections.hpp"
#include "drivers/predictor.h"

namespace unisim::pipeline {

class WindowBook {
 public:
  /// @param most newest windows that are kept
  explicit WindowBook(size_t most) : most_(most) {}

  void add(const unisim_window_prediction& window, int32_t submap_id);
  /// -1: not kept
  int32_t submap_of(int64_t token) const;

  /// As a map file keeps them.
  mapfile::Bytes bytes() const;
  /// Of a map that session and predictor have been handed: each window is asked for again as the
  /// predictor's map has it, which is as it was measured last. Those it cannot give stay as they
  /// are. Throws mapfile::Error.
  /// @param path      of the map
  /// @param keyframes of the map
  void load(const mapfile::Bytes& bytes, const std::string& path, int32_t keyframes,
            unisim_predictor* predictor);

 private:
  struct Window {
    int64_t token = -1;
    int32_t submap_id = -1;
    std::vector<int32_t> keyframes;
  };
  void add(Window window);

  size_t most_;
  size_t next_ = 0;              // of the ring
  std::vector<Window> windows_;  // a ring of the newest
};

}  // namespace unisim::pipeline
