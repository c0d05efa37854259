// SPDX-License-Identifier: MIT
// What a publisher holds, and how a message gets into its queue.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>

#include "drivers/lcm/network.hpp"
#include "drivers/lcm/publisher.h"
#include "drivers/lcm/send_queue.hpp"
#include "unisim_stage_time_t.h"
#include "unisim_trajectory_pose_t.h"

/// Made once; messages are put together in its arrays.
struct unisim_lcm_publisher {
  int32_t unit = UNISIM_LCM_UNIT_RELATIVE;
  double scale_sigma = 0.0;        // of UNISIM_LCM_UNIT_METRIC
  std::shared_ptr<lcm_t> network;  // the sending thread shares it
  lcm_subscription_t* requests = nullptr;
  int32_t wanted_id = -1;  // of the newest request, -1: none
  int64_t foreign = 0;
  std::unique_ptr<unisim::lcm::SendQueue> queue;
  std::array<unisim_trajectory_pose_t, UNISIM_LCM_CHUNK_POSES> poses{};
  std::array<unisim_stage_time_t, UNISIM_LCM_MAX_STAGES> stages{};
};

namespace unisim::lcm {

/// Rounded down.
inline int64_t microseconds(int64_t timestamp_ns) {
  return timestamp_ns / 1000 - (timestamp_ns % 1000 < 0 ? 1 : 0);
}

inline bool is_pose(const unisim_sim3& T) {
  double sum = T.s;
  for (const double value : T.t) sum += value;
  for (const double value : T.q) sum += value;
  return std::isfinite(sum) && T.s > 0.0;
}

/// On the wire quaternions are w x y z.
inline void put_pose(const unisim_sim3& T, double pos[3], double orientation[4]) {
  for (int k = 0; k < 3; ++k) pos[k] = T.t[k];
  orientation[0] = T.q[3];
  for (int k = 0; k < 3; ++k) orientation[k + 1] = T.q[k];
}

/// Encodes with the functions lcm-gen made for the message.
template <typename Message>
int put(unisim_lcm_publisher* publisher, const char* channel, const Message& message,
        int (*encoded_size)(const Message*), int (*encode)(void*, int, int, const Message*)) {
  const int size = encoded_size(&message);
  const auto write = [&](uint8_t* at) { encode(at, 0, size, &message); };
  const bool taken = publisher->queue->put(channel, static_cast<size_t>(size), write);
  return taken ? UNISIM_LCM_QUEUED : UNISIM_LCM_TOO_BIG;
}

}  // namespace unisim::lcm
