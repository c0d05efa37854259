// SPDX-License-Identifier: MIT
// The system calls of this driver, in one table that tests put their own in place of.
#pragma once

#include <poll.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace unisim::v4l2 {

/// Every call gives what the system gives, or -errno. Interrupted calls are not repeated here.
class Io {
 public:
  virtual ~Io() = default;

  /// For reading and writing, without waiting.
  virtual int open(const char* path) = 0;
  virtual int close(int fd) = 0;
  virtual int ioctl(int fd, unsigned long request, void* argument) = 0;
  virtual int map(int fd, size_t length, int64_t offset, void** address) = 0;
  virtual int unmap(void* address, size_t length) = 0;
  virtual int poll(pollfd* fds, unsigned count, int timeout_ms) = 0;
  virtual int64_t monotonic_ns() = 0;
  virtual int64_t realtime_ns() = 0;

  /// A descriptor that becomes readable, for good, by wake(); closed with close().
  virtual int make_wake() = 0;
  virtual int wake(int fd) = 0;

  /// Numbers N of the /dev/videoN that are there, in any order.
  virtual int list_numbers(std::vector<int>* numbers) = 0;
  /// The path behind links, the path itself where there are none.
  virtual std::string resolve(const std::string& path) = 0;
};

/// The system's own calls.
Io& system_io();

/// Repeats ioctl() while a signal interrupts it.
int ioctl_again(Io& io, int fd, unsigned long request, void* argument);

/// A descriptor that is closed at the end.
class Handle {
 public:
  Handle(Io& io, int fd) : io_(io), fd_(fd) {}
  ~Handle() {
    if (fd_ >= 0) io_.close(fd_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  /// < 0: -errno of what was to give it
  int fd() const { return fd_; }

 private:
  Io& io_;
  int fd_;
};

/// Opens a device, again where a signal interrupted that.
int open_again(Io& io, const char* path);

}  // namespace unisim::v4l2
