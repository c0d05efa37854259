// SPDX-License-Identifier: MIT
// Carries predictions from the predictor to the session: pairs, windows, revisions, optimisation.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/pipeline/back_lane.hpp"
#include "drivers/pipeline/distance_feeder.hpp"
#include "drivers/pipeline/latency_histogram.hpp"
#include "drivers/pipeline/listener.hpp"
#include "drivers/pipeline/loop_closer.hpp"
#include "drivers/pipeline/messages.hpp"
#include "drivers/pipeline/metre_book.hpp"
#include "drivers/pipeline/session_client.hpp"
#include "drivers/pipeline/wide_windows.hpp"
#include "drivers/pipeline/window_book.hpp"
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

/// What the lane that asks for windows beside the tracking did.
struct LaneReport {
  bool beside = false;       ///< false: windows are asked for between two frames
  int32_t lag = 0;           ///< keyframes after which an answer is taken; in realtime as it comes
  int64_t asked = 0;         ///< windows
  int64_t late = 0;          ///< taken more than `lag` keyframes after they were asked for
  int64_t dropped = 0;       ///< given up for newer ones, or too late for the session
  int32_t most_waiting = 0;  ///< windows that stood in the queue at once
  double waited_ms = 0.0;    ///< tracking stood still for an answer that was due
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
    int32_t window_step;  ///< keyframes from one window to the next
    bool realtime;        ///< answers of the lane are taken when they are there
    LoopConfig loops;     ///< for a predictor with places
    OdometryOptions odometry;
    double camera_height = 0.0;  ///< metres over the ground; 0: not known
  };

  /// Windows that may wait for the lane in a realtime run; for a newer one the oldest is dropped.
  static constexpr int32_t kMostWaiting = 2;

  /// @param max_submaps newest windows whose revisions can be followed
  MapBuilder(const Parts& parts, size_t max_submaps);

  /// Session and predictor have a map of so many keyframes: goes on after them.
  void go_on_after(int32_t keyframes);

  /// New keyframe in the session, then under its number in the predictor.
  Step add_to_session(const unisim_frame& frame, int32_t* id);
  Step add_to_predictor(const unisim_frame& frame, int32_t id);

  /// Serves pair requests until there is none or one is not known yet.
  Step serve_pairs();

  /// Windows, what was measured anew, wide windows and loops; the graph is optimised when one came
  /// in. From the predictor at once, or, where it allows that, from the lane beside the tracking.
  Step serve_back();

  /// Ends the lane: waits for the answer in work and takes it where the run goes on. Afterwards
  /// nothing runs beside the caller's thread.
  Step leave_lane(bool goes_on);

  /// Tells the listeners what has left the sliding window. To be called after each keyframe: what
  /// is not read in time the session loses.
  void tell_retired();

  /// At the end, after a last serve_pairs(): pairs that stay unknown are rejected, the last shorter
  /// window is taken, the graph is optimised until it rests.
  Step close();

  /// Last keyframe whose pair was added or rejected; 0 before the first.
  int32_t last_settled() const { return last_settled_; }
  /// Is the scale of the pair settled last a guess?
  bool scale_guessed() const { return scale_guessed_; }

  /// How long the units are, as the last optimisation left them.
  MetreBook& metres() { return metres_; }

  /// Windows of this run and of the map it goes on in.
  WindowBook& windows() { return windows_; }

  const LaneReport& lane_report() const { return report_; }

  /// What the predictor says of the run, and of loops what is known here.
  void info(unisim_predictor_info* out) const;

  /// Why a step said kPredictorFailed.
  std::string failure() const { return failure_.empty() ? predictor_message() : failure_; }

 private:
  Step serve_windows();
  Step serve_revisions();
  Step serve_wide_windows();
  Step serve_pair(const unisim_request& request, bool* pending);
  Step serve_window(const unisim_request& request, bool* pending);
  Step take_answer(const unisim_request& request, int status,
                   const unisim_window_prediction& window, const std::string& reason,
                   bool* pending);
  void take_unit(int32_t submap_id, const unisim_window_prediction& window);
  void take_height(int32_t submap_id, const unisim_window_prediction& window);
  void add_unit(const unisim_submap_unit& unit);
  /// Over the focal length; 0: given.
  double focal_sigma() const;
  Step take_window(const unisim_request& request, const unisim_window_prediction& window,
                   bool* pending);
  bool wants_wide_window() const;
  Step take_wide_window(const unisim_window_prediction& window, bool* taken);
  void make_loops();
  bool begin_loops();
  Step serve_loops();
  Step take_loop();
  void tell_places();
  void begin_turn();
  bool turn_is_due();
  Step end_turn();
  Step take_turn(const BackAnswer& answer);
  bool drop_oldest_windows(unisim_request* oldest);
  void take_revision(const unisim_window_revision& revision);
  Step reject(const unisim_request& request, MessageKind kind, const std::string& why);
  Step reject_open_pairs();
  bool next_request(uint32_t kind, unisim_request* request);
  Step optimize(int max_calls);
  Step session_failed(const char* call, unisim_status status);
  Step back_failed(const std::string& why);
  std::string window_message() const;
  std::string predictor_message() const { return parts_.predictor->message(parts_.predictor); }

  Parts parts_;
  WindowBook windows_;
  WideWindows wide_windows_;
  DistanceFeeder distances_;
  MetreBook metres_;
  int32_t image_width_ = 0;  // of the frames
  int32_t image_height_ = 0;
  std::unique_ptr<LoopCloser> loops_;  // NULL: none are looked for
  int32_t places_told_ = 0;            // looks, from the first of the run on
  int32_t last_settled_ = 0;
  bool scale_guessed_ = false;
  int32_t newest_ = -1;  // keyframe
  std::unique_ptr<BackLane> lane_;
  unisim_request asked_{};  // of the turn in work; count 0: no window
  int32_t asked_at_ = 0;    // newest keyframe then
  LaneReport report_;
  std::string failure_;
};

}  // namespace unisim::pipeline
