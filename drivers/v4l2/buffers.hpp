// SPDX-License-Identifier: MIT
// The ring of mapped buffers that the kernel fills.
#pragma once

#include <linux/videodev2.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/v4l2/io_table.hpp"

namespace unisim::v4l2 {

/// Mapped, queued and streaming from constructor to destructor.
class Buffers {
 public:
  /// @throws DeviceError
  Buffers(Io& io, int fd, const std::string& device, int count);
  ~Buffers();
  Buffers(const Buffers&) = delete;
  Buffers& operator=(const Buffers&) = delete;

  unsigned count() const { return static_cast<unsigned>(maps_.size()); }
  /// In the kernel's hands, filled or not.
  unsigned queued() const { return queued_; }

  /// @return 0, or -errno: -EAGAIN none is ready; of an answer that makes no sense -EIO
  int dequeue(v4l2_buffer* buffer);
  /// @return 0 or -errno
  int queue(uint32_t index);

  const uint8_t* data(uint32_t index) const {
    return static_cast<const uint8_t*>(maps_[index].address);
  }
  size_t length(uint32_t index) const { return maps_[index].length; }

 private:
  struct Map {
    void* address;
    size_t length;
  };

  void request(const std::string& device, int count);
  void map(const std::string& device);
  void start(const std::string& device);
  void release();

  Io& io_;
  int fd_;
  uint32_t granted_ = 0;
  unsigned queued_ = 0;
  bool streaming_ = false;
  std::vector<Map> maps_;
};

}  // namespace unisim::v4l2
