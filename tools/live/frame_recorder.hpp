// SPDX-License-Identifier: MIT
// Keeps the images of a live run as a sequence that unisim-replay reads.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "drivers/pipeline/listener.hpp"

namespace unisim::live {

/// Writes FOLDER/rgb/NNNNNN.png and FOLDER/rgb.txt: the frames that were tracked, with their stamps
/// to the nanosecond. On a thread of its own, that tracking does not wait for: when kWaiting images
/// wait for a slow disk, or the disk is nearly full, the recording ends where it is whole.
class FrameRecorder : public pipeline::Listener {
 public:
  /// Bytes of the disk that are left for the results of the run.
  static constexpr uint64_t kSpareBytes = 64 << 20;

  /// Makes the folder. Throws Failure (3): it is there with images in it, or cannot be made.
  FrameRecorder(const std::string& folder, bool force, uint64_t spare_bytes = kSpareBytes);
  /// Writes what waits.
  ~FrameRecorder() override;
  FrameRecorder(const FrameRecorder&) = delete;
  FrameRecorder& operator=(const FrameRecorder&) = delete;

  void on_frame(const unisim_frame& frame) override;

  /// Writes what waits and ends. @return why frames are missing, "" if none are
  std::string finish();

  int64_t frames() const { return written_; }

 private:
  static constexpr size_t kWaiting = 64;  // two seconds of a camera

  struct Slot {
    int64_t timestamp_ns = 0;
    unisim_image image{};
    std::vector<uint8_t> pixels;
  };

  void loop();
  std::string write(const Slot& slot);
  std::string write_image(const unisim_image& image, const std::string& path);
  void end(const std::string& why);

  std::string folder_;
  uint64_t spare_bytes_;
  std::FILE* list_ = nullptr;
  std::vector<Slot> slots_;  // a ring
  size_t head_ = 0;
  size_t filled_ = 0;
  bool stopping_ = false;
  std::string problem_;
  int64_t written_ = 0;
  std::vector<uint8_t> bytes_;  // of the image in work
  std::mutex mutex_;
  std::condition_variable changed_;
  std::thread thread_;
};

}  // namespace unisim::live
