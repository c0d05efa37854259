// SPDX-License-Identifier: MIT
// The newest whole frame out of the ring of buffers.
#include "drivers/v4l2/capture.hpp"

#include <algorithm>
#include <cerrno>
#include <cinttypes>
#include <cstdio>

#include "drivers/v4l2/jpeg_decoder.hpp"
#include "drivers/v4l2/jpeg_extent.hpp"
#include "drivers/v4l2/pixel_formats.hpp"

namespace unisim::v4l2 {
namespace {

// The driver's stamp; 0, which is of no clock, for one that no clock will ever show.
int64_t stamp_of(const v4l2_buffer& buffer) {
  constexpr int64_t kMostSeconds = 9'000'000'000;
  const int64_t seconds = buffer.timestamp.tv_sec;
  if (seconds < 0 || seconds > kMostSeconds) return 0;
  return seconds * 1'000'000'000 +
         static_cast<int64_t>(buffer.timestamp.tv_usec) % 1'000'000 * 1000;
}

constexpr const char* kFlagged = "flagged as damaged by the camera's driver";
constexpr const char* kShort = "shorter than an image";
constexpr const char* kStale = "left over from before the camera was started";
constexpr const char* kRepeated = "the one before once more";
constexpr const char* kNoJpeg = "no whole JPEG image";
constexpr const char* kOtherSize = "a JPEG image of another size";
constexpr const char* kNotDecoded = "a damaged JPEG image";

}  // namespace

void Capture::use(Device* device) {
  device_ = device;
  holds_ = false;
  ready_count_ = 0;
  since_start_ = 0;
  refreshed_ = false;
  sequence_.restart();
  if (device == nullptr) return;
  given_ = device->buffers().queued();
  last_take_ns_ = device->started_ns();
  const Mode& mode = device->mode();
  luma_.resize(static_cast<size_t>(mode.width) * static_cast<size_t>(mode.height));
}

Capture::Result Capture::fail(const char* call, int error) {
  failed_call_ = call;
  error_ = error;
  return Result::kFailed;
}

bool Capture::release() {
  if (!holds_) return true;
  holds_ = false;
  const int status = device_->buffers().queue(held_);
  if (status < 0) fail("VIDIOC_QBUF", -status);
  return status == 0;
}

Capture::Result Capture::take(bool decode, unisim_frame* frame) {
  const int status = drain();
  if (status < 0) return fail("VIDIOC_DQBUF", -status);
  if (ready_count_ == 0) return Result::kNothing;
  if (!refreshed_ && too_old()) {
    refreshed_ = true;
    counters_->superseded += static_cast<int64_t>(ready_count_);
    return give_back(nullptr) ? Result::kNothing : Result::kFailed;
  }
  refreshed_ = false;
  const Ready* chosen = choose();
  if (!give_back(chosen)) return Result::kFailed;
  if (chosen == nullptr) return report(ready_[ready_count_ - 1], ready_[ready_count_ - 1].defect);
  return deliver(*chosen, decode, frame);
}

// Not more than the ring holds: a fast camera fills again what has just been given back.
int Capture::drain() {
  ready_count_ = 0;
  const size_t most = std::min<size_t>(device_->buffers().count(), kMostBuffers);
  while (ready_count_ < most) {
    v4l2_buffer buffer;
    const int status = device_->buffers().dequeue(&buffer);
    if (status == -EAGAIN) break;
    if (status < 0) return status;
    note(buffer, {io_.monotonic_ns(), io_.realtime_ns()});
  }
  return 0;
}

void Capture::note(const v4l2_buffer& buffer, StampClock::Now now) {
  const int64_t raw_ns = stamp_of(buffer);
  Ready& ready = ready_[ready_count_++];
  ready.buffer = buffer.index;
  ready.bytes = std::min<size_t>(buffer.bytesused, device_->buffers().length(buffer.index));
  ready.defect = defect_of(buffer, ready.bytes, raw_ns, now);
  StampClock::Stamp stamp{now.monotonic_ns, false};
  if (ready.defect == nullptr) {
    stamp = clock_.map(raw_ns, now, device_->period_ns());
    if (!stamp.measured) ++counters_->restamped;
  } else {
    ++(ready.defect == kFlagged ? counters_->errors : counters_->bad);
  }
  ready.stamp_ns = stamp.ns;
  ready.measured = stamp.measured;
  const int64_t lost = sequence_.lost_before(buffer.sequence, stamp.ns, device_->period_ns());
  counters_->lost += lost;
  next_index_ += lost;
  ready.index = next_index_++;
  last_sequence_ = buffer.sequence;
  last_raw_ns_ = raw_ns;
  ++since_start_;
}

const char* Capture::defect_of(const v4l2_buffer& buffer, size_t bytes, int64_t raw_ns,
                               StampClock::Now now) {
  if ((buffer.flags & V4L2_BUF_FLAG_ERROR) != 0) return kFlagged;
  if (bytes == 0 || bytes < device_->mode().needed_bytes) return kShort;
  // Only what lay in the ring can be left over; later on it is the camera's clock that is wrong.
  int64_t stamp_ns = 0;
  if (since_start_ < device_->buffers().count() &&
      StampClock::to_monotonic(raw_ns, now, &stamp_ns) &&
      stamp_ns < device_->started_ns() - device_->period_ns()) {
    return kStale;
  }
  const bool same = since_start_ > 0 && raw_ns != 0 && raw_ns == last_raw_ns_ &&
                    buffer.sequence == last_sequence_;
  return same ? kRepeated : nullptr;
}

// The caller was away for so long that the camera ran out of buffers: the newest frame here is not
// the camera's newest, which is one period away. Two periods are the age of a frame that was just
// missed. With one buffer it cannot be told from a camera that is slow itself.
bool Capture::too_old() const {
  if (given_ < 2 || ready_count_ < given_) return false;
  const Ready& newest = ready_[ready_count_ - 1];
  const int64_t since = newest.measured ? newest.stamp_ns : last_take_ns_;
  return io_.monotonic_ns() - since > 2 * device_->period_ns();
}

const Capture::Ready* Capture::choose() {
  const Ready* chosen = nullptr;
  for (size_t i = ready_count_; i > 0; --i) {
    Ready& ready = ready_[i - 1];
    if (ready.defect != nullptr) continue;
    if (chosen != nullptr) {
      ++counters_->superseded;
      continue;
    }
    ready.defect = check_jpeg(ready);
    if (ready.defect == nullptr) {
      chosen = &ready;
    } else {
      ++counters_->bad;
    }
  }
  return chosen;
}

const char* Capture::check_jpeg(const Ready& ready) const {
  const Mode& mode = device_->mode();
  if (mode.fourcc != V4L2_PIX_FMT_MJPEG) return nullptr;
  const JpegExtent extent = jpeg_extent(device_->buffers().data(ready.buffer), ready.bytes);
  if (extent.bytes == 0) return kNoJpeg;
  return extent.width == mode.width && extent.height == mode.height ? nullptr : kOtherSize;
}

bool Capture::give_back(const Ready* but) {
  bool fine = true;
  for (size_t i = 0; i < ready_count_; ++i) {
    if (&ready_[i] == but) continue;
    const int status = device_->buffers().queue(ready_[i].buffer);
    if (status < 0) fail("VIDIOC_QBUF", -status);
    fine = fine && status == 0;
  }
  given_ = device_->buffers().queued();
  last_take_ns_ = io_.monotonic_ns();
  return fine;
}

Capture::Result Capture::deliver(const Ready& ready, bool decode, unisim_frame* frame) {
  const Mode& mode = device_->mode();
  holds_ = true;
  held_ = ready.buffer;
  frame->index = ready.index;
  frame->timestamp_ns = ready.stamp_ns;
  frame->image = {nullptr, mode.width, mode.height, mode.width, UNISIM_PIXEL_GRAY8};
  if (decode && !read_pixels(ready, &frame->image)) {
    ++counters_->bad;
    return report(ready, kNotDecoded);
  }
  ++counters_->frames;
  return Result::kFrame;
}

// The buffer stays the caller's where it has the gray pixels in it, and goes back at once where
// not; what goes wrong with that is seen at the next call.
bool Capture::read_pixels(const Ready& ready, unisim_image* image) {
  const Mode& mode = device_->mode();
  const uint8_t* data = device_->buffers().data(ready.buffer);
  image->data = luma_.data();
  bool fine = true;
  if (mode.fourcc == V4L2_PIX_FMT_YUYV) {
    extract_yuyv_luma(data, mode.width, mode.height, mode.stride, luma_.data());
  } else if (mode.fourcc == V4L2_PIX_FMT_MJPEG) {
    const JpegExtent extent = jpeg_extent(data, ready.bytes);
    fine = JpegDecoder::decode(data, extent.bytes, mode.width, mode.height, luma_.data());
  } else {
    image->data = data;
    image->stride = mode.stride;
    return true;
  }
  if (device_->buffers().queue(held_) == 0) {
    holds_ = false;
    ++given_;
  }
  return fine;
}

Capture::Result Capture::report(const Ready& ready, const char* defect) {
  std::snprintf(message_, sizeof message_, "%s: frame %" PRId64 ": %s: skipped",
                device_->path().c_str(), ready.index, defect);
  return Result::kBad;
}

}  // namespace unisim::v4l2
