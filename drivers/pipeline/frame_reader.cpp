// SPDX-License-Identifier: MIT
// A thread that reads ahead of the tracking.
#include "drivers/pipeline/frame_reader.hpp"

#include <cstring>

namespace unisim::pipeline {
namespace {

std::string size_text(const unisim_image& image) {
  return std::to_string(image.width) + "x" + std::to_string(image.height) +
         (image.format == UNISIM_PIXEL_GRAY8 ? " gray" : " colour");
}

bool same_shape(const unisim_image& a, const unisim_image& b) {
  return a.width == b.width && a.height == b.height && a.format == b.format;
}

}  // namespace

FrameReader::FrameReader(unisim_source* source, int depth, bool decode)
    : source_(source), decode_(decode), slots_(static_cast<size_t>(depth) + 1) {
  thread_ = std::thread([this] { read_loop(); });
}

FrameReader::~FrameReader() { stop(); }

void FrameReader::stop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

int FrameReader::queued() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return static_cast<int>(filled_);
}

const FrameReader::Item& FrameReader::next() {
  std::unique_lock<std::mutex> lock(mutex_);
  if (in_use_) {
    const Item& given = slots_[(head_ + slots_.size() - 1) % slots_.size()].item;
    if (given.status == UNISIM_FRAME_END || given.status == UNISIM_FRAME_FAILED) return given;
    in_use_ = false;
    changed_.notify_all();
  }
  changed_.wait(lock, [this] { return filled_ > 0; });
  const Item& item = slots_[head_].item;
  head_ = (head_ + 1) % slots_.size();
  --filled_;
  in_use_ = true;
  changed_.notify_all();
  return item;
}

void FrameReader::read_loop() {
  size_t tail = 0;
  int status = UNISIM_FRAME_OK;
  while (status == UNISIM_FRAME_OK || status == UNISIM_FRAME_BAD) {
    {
      std::unique_lock<std::mutex> lock(mutex_);
      changed_.wait(lock,
                    [this] { return stopping_ || filled_ + (in_use_ ? 1 : 0) < slots_.size(); });
      if (stopping_) return;
    }
    Slot& slot = slots_[tail];
    fill(slot);
    status = slot.item.status;
    tail = (tail + 1) % slots_.size();
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ++filled_;
    }
    changed_.notify_all();
  }
}

void FrameReader::fill(Slot& slot) {
  slot.item.message.clear();
  {
    const ScopedLatency timer(decode_times_);
    slot.item.status = source_->next_frame(source_, decode_ ? 1 : 0, &slot.item.frame);
  }
  if (slot.item.status == UNISIM_FRAME_OK)
    check(slot);
  else if (slot.item.status != UNISIM_FRAME_END)
    slot.item.message = source_->message(source_);
}

void FrameReader::check(Slot& slot) {
  const unisim_frame& frame = slot.item.frame;
  const std::string where = "frame " + std::to_string(frame.index);
  if (any_frame_ && frame.timestamp_ns <= last_timestamp_ns_) {
    slot.item.status = UNISIM_FRAME_BAD;
    slot.item.message = where + ": time stamp is not after the one before; frame skipped";
    return;
  }
  if (decode_) {
    if (any_frame_ && !same_shape(first_, frame.image)) {
      slot.item.status = UNISIM_FRAME_BAD;
      slot.item.message = where + ": image is " + size_text(frame.image) + ", the first one was " +
                          size_text(first_) + "; frame skipped";
      return;
    }
    if (!any_frame_) first_ = frame.image;
    take_pixels(slot);
  }
  any_frame_ = true;
  last_timestamp_ns_ = frame.timestamp_ns;
}

void FrameReader::take_pixels(Slot& slot) {
  unisim_image& image = slot.item.frame.image;
  const size_t row = static_cast<size_t>(image.width) * static_cast<size_t>(image.format);
  slot.pixels.resize(row * static_cast<size_t>(image.height));
  for (int32_t y = 0; y < image.height; ++y) {
    const size_t line = static_cast<size_t>(y);
    std::memcpy(slot.pixels.data() + line * row,
                image.data + line * static_cast<size_t>(image.stride), row);
  }
  image.data = slot.pixels.data();
  image.stride = static_cast<int32_t>(row);
}

}  // namespace unisim::pipeline
