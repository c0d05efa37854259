// SPDX-License-Identifier: MIT
// A thread that reads ahead of the tracking.
#include "drivers/pipeline/frame_reader.hpp"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <utility>
#include <vector>

#include "drivers/common/format.hpp"
#include "drivers/common/packed_copy.hpp"
#include "drivers/common/size_text.hpp"

namespace unisim::pipeline {
namespace {

using std::chrono::milliseconds;

// A raised flag is noticed after at most this long: shorter than people call a delay.
constexpr milliseconds kSlice(20);
// A source that is interrupted comes back at once; one that knows no interrupt may be half through
// an image. Together with the rest, a program still ends within a second.
constexpr milliseconds kFarewell(500);

std::string shape_text(const unisim_image& image) {
  return drivers::size_text(image.width, image.height) +
         (image.format == UNISIM_PIXEL_GRAY8 ? " gray" : " colour");
}

bool same_shape(const unisim_image& a, const unisim_image& b) {
  return a.width == b.width && a.height == b.height && a.format == b.format;
}

}  // namespace

class FrameReader::Shared {
 public:
  Shared(unisim_source* source, int depth, int decode, Queue queue)
      : source_(source),
        decode_(decode),
        newest_wins_(queue == Queue::kNewest),
        depth_(static_cast<size_t>(depth)),
        slots_(depth_ + (newest_wins_ ? 2 : 1)) {}

  void read_loop();
  const Item* next(const std::atomic<bool>* stop, milliseconds patience);
  /// @return false when the thread is still inside the source
  bool stop();
  bool ended() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return ended_;
  }
  int32_t waiting() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return static_cast<int32_t>(filled_);
  }
  const LatencyHistogram& decode_times() const { return decode_times_; }

 private:
  struct Slot {
    Item item;
    std::vector<uint8_t> pixels;
  };

  bool has_room() const { return newest_wins_ || filled_ + (in_use_ ? 1 : 0) < slots_.size(); }
  void queue_filled();
  int read_one(size_t at);
  void fill(Slot* slot);
  void check(Slot* slot);
  int check_shape(const std::string& where, Slot* slot);

  unisim_source* source_;
  int decode_;
  bool newest_wins_;
  size_t depth_;
  std::vector<Slot> slots_;  // in the caller's hands, queued, being filled
  size_t head_ = 0;          // slot that next() gives out next
  size_t tail_ = 0;          // slot that the reader fills
  size_t filled_ = 0;        // slots the reader has filled and next() has not passed
  bool in_use_ = false;      // slots_[head_ - 1] is still in the caller's hands
  bool stopping_ = false;
  bool ended_ = false;  // the thread has left the source for good
  Item timed_out_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  LatencyHistogram decode_times_;
  unisim_image first_{};  // shape every image must have; format 0: no image yet
  int64_t last_timestamp_ns_ = 0;
  bool any_frame_ = false;
};

const FrameReader::Item* FrameReader::Shared::next(const std::atomic<bool>* stop,
                                                   milliseconds patience) {
  std::unique_lock<std::mutex> lock(mutex_);
  if (timed_out_.status == UNISIM_FRAME_FAILED) return &timed_out_;
  if (in_use_) {
    const Item& given = slots_[(head_ + slots_.size() - 1) % slots_.size()].item;
    if (given.status == UNISIM_FRAME_END || given.status == UNISIM_FRAME_FAILED) return &given;
    in_use_ = false;
    changed_.notify_all();
  }
  const auto start = std::chrono::steady_clock::now();
  while (!changed_.wait_for(lock, kSlice, [this] { return filled_ > 0; })) {
    if (stop != nullptr && stop->load()) return nullptr;
    if (patience.count() == 0 || std::chrono::steady_clock::now() - start < patience) continue;
    timed_out_.status = UNISIM_FRAME_FAILED;
    timed_out_.message = std::string(source_->format) + " source: no frame for " +
                         drivers::format("%.1f s", static_cast<double>(patience.count()) / 1000.0) +
                         "; look at where the frames come from, or raise pipeline.patience_s";
    return &timed_out_;
  }
  const Item& item = slots_[head_].item;
  head_ = (head_ + 1) % slots_.size();
  --filled_;
  in_use_ = true;
  changed_.notify_all();
  return &item;
}

bool FrameReader::Shared::stop() {
  std::unique_lock<std::mutex> lock(mutex_);
  stopping_ = true;
  changed_.notify_all();
  if (!ended_ && source_->interrupt != nullptr) source_->interrupt(source_);
  return changed_.wait_for(lock, kFarewell, [this] { return ended_; });
}

void FrameReader::Shared::read_loop() {
  int status = UNISIM_FRAME_OK;
  std::unique_lock<std::mutex> lock(mutex_);
  while (status == UNISIM_FRAME_OK || status == UNISIM_FRAME_BAD) {
    changed_.wait(lock, [this] { return stopping_ || has_room(); });
    if (stopping_) break;
    const size_t tail = tail_;
    lock.unlock();
    status = read_one(tail);
    lock.lock();
    queue_filled();
    changed_.notify_all();
  }
  ended_ = true;
  changed_.notify_all();
}

/// The slot at the tail has been filled.
void FrameReader::Shared::queue_filled() {
  Slot& filled = slots_[tail_];
  filled.item.made_way = 0;
  if (!newest_wins_ || filled_ < depth_) {
    tail_ = (tail_ + 1) % slots_.size();
    ++filled_;
    return;
  }
  Slot& last = slots_[(tail_ + slots_.size() - 1) % slots_.size()];
  const int64_t made_way = last.item.made_way + 1;
  std::swap(last, filled);  // pixels keep their place in memory
  last.item.made_way = made_way;
}

/// No exception leaves the thread: it would end the program.
int FrameReader::Shared::read_one(size_t at) {
  Slot& slot = slots_[at];
  try {
    fill(&slot);
  } catch (const std::exception& error) {
    slot.item.status = UNISIM_FRAME_FAILED;
    slot.item.message = std::string(source_->format) + " source: " + error.what();
  }
  return slot.item.status;
}

void FrameReader::Shared::fill(Slot* slot) {
  slot->item.message.clear();
  {
    const ScopedLatency timer(decode_times_);
    slot->item.status = source_->next_frame(source_, decode_, &slot->item.frame);
  }
  if (slot->item.status == UNISIM_FRAME_OK)
    check(slot);
  else if (slot->item.status != UNISIM_FRAME_END)
    slot->item.message = source_->message(source_);
}

void FrameReader::Shared::check(Slot* slot) {
  const unisim_frame& frame = slot->item.frame;
  const std::string where = "frame " + std::to_string(frame.index);
  if (any_frame_ && frame.timestamp_ns <= last_timestamp_ns_) {
    slot->item.status = UNISIM_FRAME_BAD;
    slot->item.message = where + ": time stamp is not after the one before; frame skipped";
    return;
  }
  if (decode_ != 0) {
    slot->item.status = check_shape(where, slot);
    if (slot->item.status != UNISIM_FRAME_OK) return;
  }
  any_frame_ = true;
  last_timestamp_ns_ = frame.timestamp_ns;
}

/// Every image has the shape of the first. One that has not is no image of the sequence.
int FrameReader::Shared::check_shape(const std::string& where, Slot* slot) {
  unisim_image& image = slot->item.frame.image;
  const bool if_readable = decode_ == UNISIM_DECODE_IF_READABLE;
  if (image.data == nullptr && if_readable) {
    slot->item.message = source_->message(source_);
    return UNISIM_FRAME_OK;
  }
  if (first_.format == 0) first_ = image;
  if (same_shape(first_, image)) {
    image = drivers::packed_copy(image, &slot->pixels);
    return UNISIM_FRAME_OK;
  }
  slot->item.message = where + ": image is " + shape_text(image) + ", the first one was " +
                       shape_text(first_) + (if_readable ? "" : "; frame skipped");
  image = {};
  return if_readable ? UNISIM_FRAME_OK : UNISIM_FRAME_BAD;
}

FrameReader::FrameReader(unisim_source* source, int depth, int decode, Queue queue)
    : shared_(std::make_shared<Shared>(source, depth, decode, queue)),
      thread_([shared = shared_] { shared->read_loop(); }) {}

FrameReader::~FrameReader() { stop(); }

const FrameReader::Item* FrameReader::next(const std::atomic<bool>* stop, milliseconds patience) {
  return shared_->next(stop, patience);
}

int32_t FrameReader::waiting() const { return shared_->waiting(); }

void FrameReader::stop() {
  if (!thread_.joinable()) return;
  if (shared_->stop())
    thread_.join();
  else
    thread_.detach();
}

bool FrameReader::holds_source() const { return !shared_->ended(); }

LatencyHistogram FrameReader::decode_times() const {
  return holds_source() ? LatencyHistogram() : shared_->decode_times();
}

}  // namespace unisim::pipeline
