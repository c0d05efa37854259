// SPDX-License-Identifier: MIT
// Asks a predictor for windows on a thread of its own, beside the tracking.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "drivers/pipeline/loop_closer.hpp"
#include "drivers/predictor.h"
#include "unisim/unisim.h"

namespace unisim::pipeline {

/// What a predictor says in one turn of the lane: a window, what it has measured anew, a wide
/// window. Borrowed from the predictor until the next turn, revisions are copies.
struct BackAnswer {
  /// A revision with its arrays.
  struct Revision {
    unisim_window_revision revision{};  ///< points into the arrays
    std::vector<unisim_sim3> poses;
    std::vector<double> log_depth_ratio;
  };

  int window_status = UNISIM_PREDICTION_PENDING;  ///< UNISIM_PREDICTION_*
  unisim_window_prediction window{};
  double window_ms = 0.0;     ///< of the window
  std::string window_reason;  ///< of a rejected window

  std::vector<Revision> revisions;
  size_t revision_count = 0;  ///< of them in use

  int wide_status = UNISIM_PREDICTION_PENDING;
  unisim_window_prediction wide{};

  double loop_ms = 0.0;  ///< of the search for loops; what it found is with the LoopCloser

  std::string failure;  ///< the predictor is of no more use: why
};

/// One question at a time, asked and answered on the caller's thread; between the two the predictor
/// works on the lane's. What waits meanwhile waits in the session.
class BackLane {
 public:
  /// @param predictor with concurrent_windows; borrowed
  /// @param max_views of a wide window
  /// @param loops searches in a turn; NULL: never. Borrowed, and the lane's until a turn is over
  BackLane(unisim_predictor* predictor, int32_t max_views, LoopCloser* loops);
  /// Waits for the turn in progress.
  ~BackLane();
  BackLane(const BackLane&) = delete;
  BackLane& operator=(const BackLane&) = delete;

  /// Begins a turn.
  /// @param window NULL: none is wanted
  /// @param wide   a wide window, if there is one
  /// @param loops  what LoopCloser::begin() handed over; not in a turn with a window, whose answer
  ///               the predictor would write over
  void ask(const unisim_request* window, bool wide, bool loops);
  /// Between ask() and done().
  bool busy() const { return busy_; }
  /// The turn is over: wait() returns at once.
  bool answered() const;
  /// Waits for the end of the turn. The answer is valid until done().
  const BackAnswer& wait();
  void done() { busy_ = false; }

 private:
  void loop();
  void turn();
  void predict_window();
  void copy_revisions();
  void take_wide_window();
  void search_loops();

  unisim_predictor* predictor_;
  int32_t max_views_;
  LoopCloser* loops_;
  bool busy_ = false;  // of the caller's thread
  bool wants_window_ = false;
  bool wants_wide_ = false;
  bool wants_loops_ = false;
  unisim_request request_{};
  BackAnswer answer_;
  bool asked_ = false;  // the turn is the lane's
  bool stopping_ = false;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::thread thread_;
};

}  // namespace unisim::pipeline
