// SPDX-License-Identifier: MIT
// A thread that reads ahead of the tracking: source -> bounded queue of decoded frames.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include "drivers/pipeline/latency_histogram.hpp"
#include "drivers/source.h"

namespace unisim::pipeline {

/// Reads a source on its own thread. Holds `depth` image buffers, and one or two more, for good;
/// frames come out in order.
class FrameReader {
 public:
  /// What happens when the queue is full.
  enum class Queue {
    kWaits,   ///< the source is left alone: every frame comes out, whatever the two threads' timing
    kNewest,  ///< a camera does not wait: the frame that would have come out last makes way
  };

  /// @param source borrowed, used by the reader's thread only; until destruction, or for ever where
  ///               holds_source() says so then
  /// @param depth  frames read ahead, >= 1
  /// @param decode as of unisim_source::next_frame()
  FrameReader(unisim_source* source, int depth, int decode, Queue queue = Queue::kWaits);
  ~FrameReader();
  FrameReader(const FrameReader&) = delete;
  FrameReader& operator=(const FrameReader&) = delete;

  /// One answer of the source.
  struct Item {
    int status = UNISIM_FRAME_END;  ///< UNISIM_FRAME_*
    unisim_frame frame{};           ///< valid until the next call of next()
    std::string message;   ///< for UNISIM_FRAME_BAD and _FAILED; with _OK why pixels are missing
    int64_t made_way = 0;  ///< frames given up for this one, of Queue::kNewest
  };

  /// Next answer, waiting for it. After END or FAILED the same answer again.
  /// @param stop     NULL, or a flag that ends the wait
  /// @param patience a source that gives nothing for so long has failed; 0: no end to it
  /// @return NULL once `stop` is raised
  const Item* next(const std::atomic<bool>* stop, std::chrono::milliseconds patience);

  /// Answers that are read and not yet given out.
  int32_t waiting() const;

  /// Stops reading, interrupts the source and waits for it a little; safe to call more than once.
  void stop();
  /// After stop(): the source has not come back from its last call. It must not be destroyed.
  bool holds_source() const;
  /// Complete after stop(), unless the source is held.
  LatencyHistogram decode_times() const;

 private:
  class Shared;  // with the thread, which outlives the reader where a source does not come back

  std::shared_ptr<Shared> shared_;
  std::thread thread_;
};

}  // namespace unisim::pipeline
