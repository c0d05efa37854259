// SPDX-License-Identifier: MIT
// One open and streaming camera.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "drivers/v4l2/buffers.hpp"
#include "drivers/v4l2/controls.hpp"
#include "drivers/v4l2/enumerate.hpp"
#include "drivers/v4l2/io_table.hpp"
#include "drivers/v4l2/negotiate.hpp"
#include "drivers/v4l2/settings.hpp"

namespace unisim::v4l2 {

/// Opened, set up and started by the constructor; the destructor puts the controls back.
class Device {
 public:
  /// @param memory controls as first found; kept from one opening to the next
  /// @throws DeviceError
  Device(Io& io, const std::string& path, const Settings& settings, ControlMemory* memory,
         std::vector<std::string>* notes);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  const std::string& path() const { return path_; }
  int fd() const { return handle_.fd(); }
  const Identity& identity() const { return identity_; }
  const Mode& mode() const { return mode_; }
  Buffers& buffers() { return *buffers_; }
  int64_t started_ns() const { return started_ns_; }
  /// Time between frames, about.
  int64_t period_ns() const { return period_ns_; }

 private:
  Io& io_;
  std::string path_;
  Handle handle_;
  ControlMemory* memory_;
  Identity identity_;
  Mode mode_{};
  int64_t period_ns_ = 0;
  int64_t started_ns_ = 0;
  std::unique_ptr<Buffers> buffers_;
};

}  // namespace unisim::v4l2
