// SPDX-License-Identifier: MIT
// Carries predictions from the predictor to the session: pairs, windows, revisions, optimisation.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/pipeline/latency_histogram.hpp"
#include "drivers/pipeline/listener.hpp"
#include "drivers/pipeline/messages.hpp"
#include "drivers/pipeline/session_client.hpp"
#include "drivers/pipeline/wide_windows.hpp"
#include "drivers/predictor.h"
#include "unisim/unisim.h"

namespace unisim::pipeline {

/// How a step ended. Everything but kOk ends the run.
enum class Step {
  kOk,
  kPredictorFailed,  ///< the predictor said FAILED
  kCapacity,         ///< the session is full
  kSessionFailed,    ///< the session refused a call that must work
};

/// Serves the requests of one session from one predictor. Owns neither.
class MapBuilder {
 public:
  struct Parts {
    SessionClient* session;
    unisim_predictor* predictor;
    StageTimes* times;
    Messages* messages;
    const std::vector<Listener*>* listeners;
    int32_t window_size;  ///< views a submap can have
  };

  /// @param max_submaps newest windows whose revisions can be followed
  MapBuilder(const Parts& parts, size_t max_submaps);

  /// New keyframe in session and predictor, under one number.
  Step add_keyframe(const unisim_frame& frame, int32_t* id);

  /// Serves pair requests until there is none or one is not known yet.
  Step serve_pairs();

  /// The same for windows; the graph is optimised when one came in.
  Step serve_windows();

  /// Takes windows that were measured anew; the graph is optimised when one came in.
  Step serve_revisions();

  /// Takes wide windows; the graph is optimised when one came in.
  Step serve_wide_windows();

  /// Tells the listeners what has left the sliding window. To be called after each keyframe: what
  /// is not read in time the session loses.
  void tell_retired();

  /// At the end, after a last serve_pairs(): pairs that stay unknown are rejected, the last shorter
  /// window is taken, the graph is optimised until it rests.
  Step close();

  /// Last keyframe whose pair was added or rejected; 0 before the first.
  int32_t last_settled() const { return last_settled_; }

 private:
  struct TokenOfSubmap {
    int64_t token;
    int32_t submap_id;
  };

  Step serve_pair(const unisim_request& request, bool* pending);
  Step serve_window(const unisim_request& request, bool* pending);
  Step take_window(const unisim_request& request, const unisim_window_prediction& window,
                   bool* pending);
  void take_revision(const unisim_window_revision& revision);
  Step reject(const unisim_request& request, MessageKind kind, const std::string& why);
  Step reject_open_pairs();
  bool next_request(uint32_t kind, unisim_request* request);
  Step optimize(int max_calls);
  Step session_failed(const char* call, unisim_status status);
  std::string predictor_message() const { return parts_.predictor->message(parts_.predictor); }

  Parts parts_;
  std::vector<TokenOfSubmap> tokens_;  // a ring of the newest
  size_t next_token_ = 0;
  WideWindows wide_windows_;
  int32_t last_settled_ = 0;
};

}  // namespace unisim::pipeline
