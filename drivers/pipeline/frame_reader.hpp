// SPDX-License-Identifier: MIT
// A thread that reads ahead of the tracking: source -> bounded queue of decoded frames.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "drivers/pipeline/latency_histogram.hpp"
#include "drivers/source.h"

namespace unisim::pipeline {

/// Reads a source on its own thread. Holds `depth` image buffers for good; frames come out in
/// order, so the result does not depend on the timing of the two threads.
class FrameReader {
 public:
  /// @param source borrowed until destruction, used by the reader's thread only
  /// @param depth  frames read ahead, >= 1
  /// @param decode false: frames come without pixels
  FrameReader(unisim_source* source, int depth, bool decode);
  ~FrameReader();
  FrameReader(const FrameReader&) = delete;
  FrameReader& operator=(const FrameReader&) = delete;

  /// One answer of the source.
  struct Item {
    int status = UNISIM_FRAME_END;  ///< UNISIM_FRAME_*
    unisim_frame frame{};           ///< valid until the next call of next()
    std::string message;            ///< for UNISIM_FRAME_BAD and _FAILED
  };

  /// Next answer, waiting for it. After END or FAILED the same answer again.
  const Item& next();

  /// Answers waiting in the queue.
  int queued() const;

  /// Stops reading; safe to call more than once. The times are complete afterwards.
  void stop();
  const LatencyHistogram& decode_times() const { return decode_times_; }

 private:
  struct Slot {
    Item item;
    std::vector<uint8_t> pixels;
  };

  void read_loop();
  void fill(Slot& slot);
  void check(Slot& slot);
  void take_pixels(Slot& slot);

  unisim_source* source_;
  bool decode_;
  std::vector<Slot> slots_;
  size_t head_ = 0;      // slot that next() gives out next
  size_t filled_ = 0;    // slots the reader has filled and next() has not passed
  bool in_use_ = false;  // slots_[head_ - 1] is still in the caller's hands
  bool stopping_ = false;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  LatencyHistogram decode_times_;
  unisim_image first_{};  // shape every image must have
  int64_t last_timestamp_ns_ = 0;
  bool any_frame_ = false;
  std::thread thread_;
};

}  // namespace unisim::pipeline
