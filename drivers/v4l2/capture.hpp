// SPDX-License-Identifier: MIT
// The newest whole frame out of the ring of buffers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "drivers/source.h"
#include "drivers/v4l2/counters.hpp"
#include "drivers/v4l2/device.hpp"
#include "drivers/v4l2/io_table.hpp"
#include "drivers/v4l2/sequence_count.hpp"
#include "drivers/v4l2/stamp_clock.hpp"

namespace unisim::v4l2 {

/// Lives as long as the source, while devices come and go.
class Capture {
 public:
  enum class Result { kFrame, kNothing, kBad, kFailed };

  Capture(Io& io, Counters* counters) : io_(io), counters_(counters) {}

  /// Frames come from this device from now on. @param device NULL: from none
  void use(Device* device);

  /// Takes out all that is ready, gives the newest whole frame and the rest back to the camera.
  /// The frame's pixels are the caller's until release().
  Result take(bool decode, unisim_frame* frame);

  /// Gives the buffer of the frame back to the camera. @return false: failed
  bool release();

  /// Of kBad: one line.
  const char* message() const { return message_; }
  /// Of kFailed: the call and its errno.
  const char* failed_call() const { return failed_call_; }
  int error() const { return error_; }

 private:
  struct Ready {
    uint32_t buffer;
    size_t bytes;
    int64_t index;
    int64_t stamp_ns;
    bool measured;
    const char* defect;  // NULL: none known
  };

  Result fail(const char* call, int error);
  int drain();
  void note(const v4l2_buffer& buffer, StampClock::Now now);
  const char* defect_of(const v4l2_buffer& buffer, size_t bytes, int64_t raw_ns,
                        StampClock::Now now);
  bool too_old() const;
  const Ready* choose();
  const char* check_jpeg(const Ready& ready) const;
  bool give_back(const Ready* but);
  Result deliver(const Ready& ready, bool decode, unisim_frame* frame);
  bool read_pixels(const Ready& ready, unisim_image* image);
  Result report(const Ready& ready, const char* defect);

  static constexpr size_t kMostBuffers = 32;  // VIDEO_MAX_FRAME of the kernel

  Io& io_;
  Counters* counters_;
  Device* device_ = nullptr;
  StampClock clock_;
  SequenceCount sequence_;
  Ready ready_[kMostBuffers];
  size_t ready_count_ = 0;
  std::vector<uint8_t> luma_;
  int64_t next_index_ = 0;
  int64_t last_take_ns_ = 0;  // when the ring was emptied last
  unsigned given_ = 0;        // buffers the camera had to fill since then
  unsigned since_start_ = 0;  // buffers taken out since the stream began
  uint32_t last_sequence_ = 0;
  int64_t last_raw_ns_ = 0;
  bool refreshed_ = false;  // old frames were given up, the next one is taken as it is
  bool holds_ = false;
  uint32_t held_ = 0;
  const char* failed_call_ = "";
  int error_ = 0;
  char message_[256] = "";
};

}  // namespace unisim::v4l2
