// SPDX-License-Identifier: MIT
// How long the units of a session's segments are: asked once for each state of the map.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/pipeline/listener.hpp"
#include "drivers/pipeline/session_client.hpp"

namespace unisim::pipeline {

/// Worth telling those who have the older one: known or not, or a quarter of its standard deviation
/// apart.
bool differs(const Metre& now, const Metre& before);

/// Asking a session costs a factorisation: not for each pose.
class MetreBook {
 public:
  explicit MetreBook(SessionClient* session) : session_(session) {}

  /// Of a segment as unisim_pose has it.
  Metre of(int32_t segment);
  /// The map was optimised: now, before anything else changes it, a session says how sure it is.
  void refresh();

 private:
  struct Known {
    int32_t segment;
    Metre metre;
  };
  SessionClient* session_;
  std::vector<Known> known_;
};

}  // namespace unisim::pipeline
