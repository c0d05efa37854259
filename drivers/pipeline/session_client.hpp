// SPDX-License-Identifier: MIT
// The one place of the pipeline that calls a session: each call is timed and watched.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "drivers/pipeline/heap_watch.hpp"
#include "drivers/pipeline/latency_histogram.hpp"
#include "drivers/predictor.h"
#include "unisim/unisim.h"

namespace unisim::pipeline {

/// Whether a run can begin.
struct Preparation {
  enum class Answer { kReady, kBadConfiguration, kNoMemory, kFailed };
  Answer answer = Answer::kReady;
  std::string message;  ///< one line unless kReady
};

/// A session with its arena. Takes predictions as predictors give them. Results mean what
/// unisim.h says; outputs are written on UNISIM_OK only.
class SessionClient {
 public:
  /// @param times, watch borrowed; they must outlive the client
  SessionClient(StageTimes* times, const HeapWatch* watch) : times_(times), watch_(watch) {}
  ~SessionClient();
  SessionClient(const SessionClient&) = delete;
  SessionClient& operator=(const SessionClient&) = delete;

  Preparation create(const unisim_config& config);
  /// NULL before create() or when it failed.
  unisim_session* handle() const { return session_; }
  /// Largest center_sigma with which a loop is taken.
  double loop_gate() const { return loop_gate_; }

  unisim_status add_keyframe(int64_t timestamp_ns, int32_t* id);
  unisim_status add_two_view(int32_t i, int32_t j, const unisim_pair_prediction& pair);
  unisim_status add_submap(const unisim_window_prediction& window, int32_t* submap_id);
  unisim_status add_loop(const unisim_window_prediction& window, int32_t* submap_id);
  unisim_status remove_loop(int32_t submap_id);
  /// @param distance struct_size is set here
  unisim_status add_distance(unisim_distance distance);
  unisim_status add_submap_unit(unisim_submap_unit unit);
  unisim_status get_scale(int32_t segment, unisim_scale* scale);
  unisim_status update_submap(int32_t submap_id, const unisim_window_revision& revision);
  unisim_status reject(const unisim_request& request);
  unisim_status close_window();
  unisim_status optimize(unisim_report* report);

  unisim_status next_request(uint32_t kinds, unisim_request* request) const;
  unisim_status get_pose(int32_t keyframe_id, unisim_pose* pose) const;
  /// What has left the window, each once; UNISIM_ERR_NOT_READY when there is nothing new.
  unisim_status next_retired(unisim_retired* retired);
  unisim_status get_info(unisim_session_info* info) const;

 private:
  template <typename Call>
  unisim_status timed(LatencyHistogram StageTimes::* stage, Call call) const;

  StageTimes* times_;
  const HeapWatch* watch_;
  std::unique_ptr<char[]> arena_;
  unisim_session* session_ = nullptr;
  double loop_gate_ = 0.0;
};

}  // namespace unisim::pipeline
