// SPDX-License-Identifier: MIT
// A camera as a source of frames: waiting, losing it, finding it again.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/source.h"
#include "drivers/v4l2/capture.hpp"
#include "drivers/v4l2/controls.hpp"
#include "drivers/v4l2/counters.hpp"
#include "drivers/v4l2/device.hpp"
#include "drivers/v4l2/find_device.hpp"
#include "drivers/v4l2/io_table.hpp"
#include "drivers/v4l2/settings.hpp"
#include "drivers/v4l2/v4l2.h"

namespace unisim::v4l2 {

class CameraSource : public unisim_source {
 public:
  /// @throws DeviceError
  CameraSource(Io& io, const Settings& settings);
  ~CameraSource();
  CameraSource(const CameraSource&) = delete;
  CameraSource& operator=(const CameraSource&) = delete;

  const std::vector<std::string>& notes() const { return notes_; }
  const unisim_v4l2_mode& mode() const { return mode_; }
  const Counters& counters() const { return counters_; }

 private:
  enum class Wake { kReady, kTrouble, kTimeout, kInterrupted, kFailed };

  void fill_table();
  void fill_mode();
  int read(bool decode, unisim_frame* frame);
  int read_frame(bool decode, unisim_frame* frame);
  int take_frame(bool decode, bool trouble, unisim_frame* frame, bool* again);
  Wake wait(int fd, int64_t deadline_ns);
  int lose(const char* call, int error);
  int come_back();
  bool open_again(std::string* reason);
  int give_up(const char* text);
  void stop();

  Io& io_;
  Settings settings_;
  Counters counters_;
  ControlMemory controls_;
  std::vector<std::string> notes_;
  unisim_v4l2_mode mode_{};
  Handle wake_;
  std::atomic<bool> interrupted_{false};
  std::unique_ptr<Device> device_;
  Capture capture_;
  Anchor anchor_;
  bool failed_ = false;
  bool unplugged_ = false;     // the last time, else the stream alone broke
  int64_t lost_since_ns_ = 0;  // since the last frame; 0: not lost
  int losses_ = 0;             // since the last frame
  int damaged_ = 0;            // in a row
  int poll_error_ = 0;
  char message_[768] = "";
};

}  // namespace unisim::v4l2
