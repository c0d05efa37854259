// SPDX-License-Identifier: MIT
// Cameras that are not there: system calls over scripted devices and a clock of their own.
#pragma once

#include <linux/videodev2.h>

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "drivers/v4l2/io_table.hpp"

namespace unisim::test {

/// One frame as it goes into a buffer; the camera's script may change it.
struct FakeFrame {
  uint32_t sequence;
  int64_t stamp_ns;
  uint32_t flags;
  std::vector<uint8_t> bytes;
  bool never_comes;  ///< lost on the way
};

struct FakeSize {
  int32_t width;
  int32_t height;
  std::vector<double> rates;
};

struct FakeFormat {
  uint32_t fourcc;
  std::vector<FakeSize> sizes;
  int32_t step =
      0;  ///< > 0: all sizes from the first to the last, in such steps, at the first's rates
};

struct FakeControl {
  int32_t minimum;
  int32_t maximum;
  int32_t value;
  std::vector<int32_t> choices;  ///< of a menu
};

/// A camera, plugged in or not. All of it may be changed at any time.
struct FakeCamera {
  std::string driver = "fakevideo";
  std::string card = "Fake Camera";
  std::string bus = "usb-fake-1";
  uint32_t capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  std::vector<FakeFormat> formats = {{V4L2_PIX_FMT_YUYV, {{640, 480, {30.0}}}},
                                     {V4L2_PIX_FMT_GREY, {{640, 480, {30.0}}}}};
  bool lists_sizes = true;
  std::map<uint32_t, FakeControl> controls;
  int32_t row_padding = 0;   ///< bytes at the end of each row
  int32_t forced_width = 0;  ///< a size that S_FMT gives whatever is asked
  int32_t forced_height = 0;
  uint32_t most_buffers = 32;
  bool silent = false;         ///< streams, but no frame ever comes
  bool broken_stream = false;  ///< EIO until the stream is stopped
  uint32_t next_sequence = 0;  ///< goes on from stream to stream
  std::function<void(FakeFrame*)> script;
};

/// Gray value of a pixel of frame n.
inline uint8_t fake_gray(int32_t x, int32_t y, uint32_t n) {
  return static_cast<uint8_t>(static_cast<uint32_t>(x + 2 * y) + n);
}

class FakeIo : public v4l2::Io {
 public:
  void plug(int number, std::shared_ptr<FakeCamera> camera);
  void unplug(int number);

  /// The calls from the nth (0: the next) of this name on fail, so many times.
  void fail(const std::string& call, int error, int nth = 0, int times = 1);
  int calls(const std::string& call) const;
  void forget_calls() { counts_.clear(); }

  /// Something happens at a moment of the clock.
  void at(int64_t ns, std::function<void()> event) { events_.emplace(ns, std::move(event)); }
  /// Time goes by outside of the driver.
  void sleep_ns(int64_t ns) { advance(now_ns_ + ns); }
  int64_t now_ns() const { return now_ns_; }
  void step_realtime(int64_t ns) { realtime_offset_ns_ += ns; }
  /// A wait with nothing to come is a real one, until a wake from another thread.
  void wait_for_real() { waits_for_real_ = true; }

  int open_files() const { return static_cast<int>(files_.size() + wakes_); }
  int mappings() const { return static_cast<int>(mappings_.size()); }

  bool is_mapped(const void* address) const {
    return mappings_.count(const_cast<void*>(address)) == 1;
  }

  int open(const char* path) override;
  int close(int fd) override;
  int ioctl(int fd, unsigned long request, void* argument) override;
  int map(int fd, size_t length, int64_t offset, void** address) override;
  int unmap(void* address, size_t length) override;
  int poll(pollfd* fds, unsigned count, int timeout_ms) override;
  int64_t monotonic_ns() override { return now_ns_ += 1000; }
  int64_t realtime_ns() override { return now_ns_ + realtime_offset_ns_; }
  int make_wake() override;
  int wake(int fd) override;
  int list_numbers(std::vector<int>* numbers) override;
  std::string resolve(const std::string& path) override;

 private:
  using Bytes = std::shared_ptr<std::vector<uint8_t>>;
  struct File {
    std::shared_ptr<FakeCamera> camera;
    bool gone = false;
    bool streaming = false;
    v4l2_pix_format pixels{};
    double fps = 5;
    int64_t next_due_ns = 0;
    std::vector<Bytes> buffers;
    std::deque<uint32_t> queued;
    std::deque<v4l2_buffer> done;
  };
  struct Fault {
    int error;
    int skip;
    int times;
  };

  int fault(const std::string& call);
  void advance(int64_t to_ns);
  void expose(File* file);
  FakeFrame make_frame(const File& file) const;
  int answer(File* file, unsigned long request, void* argument);
  static int query_capabilities(const File& file, v4l2_capability* answer);
  static int list_format(const File& file, v4l2_fmtdesc* entry);
  static int list_size(const File& file, v4l2_frmsizeenum* entry);
  static int list_rate(const File& file, v4l2_frmivalenum* entry);
  static int set_format(File* file, v4l2_format* format);
  static int set_rate(File* file, v4l2_streamparm* parameters);
  static int get_rate(const File& file, v4l2_streamparm* parameters);
  static int query_control(const File& file, v4l2_queryctrl* range);
  static int query_menu(const File& file, const v4l2_querymenu& entry);
  static int get_control(const File& file, v4l2_control* control);
  static int set_control(File* file, const v4l2_control& control);
  static int request_buffers(File* file, v4l2_requestbuffers* request);
  static int query_buffer(const File& file, v4l2_buffer* buffer);
  static int queue(File* file, const v4l2_buffer& buffer);
  static int dequeue(File* file, v4l2_buffer* buffer);
  int start(File* file) const;
  static int stop(File* file);

  std::map<int, std::shared_ptr<FakeCamera>> nodes_;
  std::map<int, File> files_;
  std::map<void*, Bytes> mappings_;
  std::map<std::string, int> counts_;
  std::map<std::string, Fault> faults_;
  std::multimap<int64_t, std::function<void()>> events_;
  size_t wakes_ = 0;
  std::vector<int> wake_fds_;
  int next_fd_ = 100000;
  int64_t now_ns_ = 1'000'000'000'000;
  int64_t realtime_offset_ns_ = 1'700'000'000'000'000'000;
  bool waits_for_real_ = false;
};

}  // namespace unisim::test
