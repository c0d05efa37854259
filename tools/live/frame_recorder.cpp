// SPDX-License-Identifier: MIT
// Keeps the images of a live run as a sequence that unisim-replay reads.
#include "tools/live/frame_recorder.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <system_error>

#include "drivers/common/format.hpp"
#include "drivers/common/image_mat.hpp"
#include "drivers/common/packed_copy.hpp"
#include "drivers/common/stamp_text.hpp"
#include "tools/common/failure.hpp"
#include "tools/live/scheduling.hpp"

namespace unisim::live {
namespace {

namespace fs = std::filesystem;

std::string name_of(int64_t number) {
  return "rgb/" + drivers::format("%06lld", static_cast<long long>(number)) + ".png";
}

}  // namespace

FrameRecorder::FrameRecorder(const std::string& folder, bool force, uint64_t spare_bytes)
    : folder_(folder), spare_bytes_(spare_bytes), slots_(kWaiting) {
  std::error_code error;
  const fs::path images = fs::path(folder) / "rgb";
  if (!force && fs::exists(images / "000000.png", error)) {
    throw tools::Failure(tools::kExitUsage, folder +
                                                ": holds a recording; give --force to replace "
                                                "it");
  }
  fs::remove_all(images, error);
  fs::create_directories(images, error);
  if (error) throw tools::Failure(tools::kExitInput, folder + ": " + error.message());
  const std::string list = folder + "/rgb.txt";
  list_ = std::fopen(list.c_str(), "w");
  if (list_ == nullptr) throw tools::Failure(tools::kExitInput, list + ": " + std::strerror(errno));
  std::fprintf(list_, "# frames of unisim-live as they were tracked: timestamp_s filename\n");
  thread_ = std::thread([this] { loop(); });
}

FrameRecorder::~FrameRecorder() { finish(); }

void FrameRecorder::on_frame(const unisim_frame& frame) {
  if (frame.image.data == nullptr) return;
  std::unique_lock<std::mutex> lock(mutex_);
  if (!problem_.empty()) return;
  if (filled_ == slots_.size()) {
    problem_ = folder_ +
               ": images come faster than this disk and processor write them; the recording ends "
               "after " +
               std::to_string(written_ + static_cast<int64_t>(filled_)) + " frames";
    return;
  }
  Slot& slot = slots_[(head_ + filled_) % slots_.size()];
  lock.unlock();  // the writer does not touch a slot that is not filled
  slot.timestamp_ns = frame.timestamp_ns;
  slot.image = drivers::packed_copy(frame.image, &slot.pixels);
  lock.lock();
  ++filled_;
  changed_.notify_all();
}

std::string FrameRecorder::finish() {
  if (!thread_.joinable()) return problem_;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
  if (std::fclose(list_) != 0) end(folder_ + "/rgb.txt: " + std::strerror(errno));
  return problem_;
}

void FrameRecorder::end(const std::string& why) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (problem_.empty()) problem_ = why;
}

void FrameRecorder::loop() {
  share_as_usual();
  std::unique_lock<std::mutex> lock(mutex_);
  bool failed = false;
  for (;;) {
    changed_.wait(lock, [this] { return filled_ > 0 || stopping_; });
    if (filled_ == 0) return;
    const Slot& slot = slots_[head_];
    lock.unlock();
    const std::string why = failed ? "" : write(slot);
    if (!why.empty()) {
      failed = true;  // the list ends with the last whole image
      end(why);
    }
    lock.lock();
    head_ = (head_ + 1) % slots_.size();
    --filled_;
  }
}

/// Not by OpenCV's own function: it does not say why a file cannot be written.
/// @return why not, "" when it is there; else there is nothing
std::string FrameRecorder::write_image(const unisim_image& image, const std::string& path) {
  // The least compression: larger files, a third of the time.
  constexpr int kLevel = 1;
  try {
    if (!cv::imencode(".png", drivers::image_mat(image), bytes_,
                      {cv::IMWRITE_PNG_COMPRESSION, kLevel})) {
      return "an image cannot be encoded";
    }
  } catch (const std::exception& error) {
    return error.what();
  }
  std::FILE* const file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) return std::strerror(errno);
  errno = 0;
  const bool whole = std::fwrite(bytes_.data(), 1, bytes_.size(), file) == bytes_.size();
  const int why = errno;
  if (std::fclose(file) == 0 && whole) return "";
  const std::string reason = std::strerror(whole || why == 0 ? errno : why);
  std::remove(path.c_str());
  return reason;
}

/// @return why not, "" when the image is there and listed
std::string FrameRecorder::write(const Slot& slot) {
  const std::string name = name_of(written_);
  std::error_code unknown;
  const auto left = fs::space(folder_, unknown).available;
  std::string why;
  if (!unknown && left < spare_bytes_) {
    why = "the disk has " + std::to_string(left >> 20) + " MB left, which are kept for the results";
  } else {
    why = write_image(slot.image, folder_ + "/" + name);
  }
  const bool listed = why.empty() &&
                      std::fprintf(list_, "%s %s\n", drivers::stamp_text(slot.timestamp_ns).c_str(),
                                   name.c_str()) > 0 &&
                      std::fflush(list_) == 0;
  if (listed) {
    ++written_;
    return "";
  }
  if (why.empty()) why = std::strerror(errno);
  return folder_ + ": " + why + "; the recording ends after " + std::to_string(written_) +
         " frames, tracking goes on";
}

}  // namespace unisim::live
