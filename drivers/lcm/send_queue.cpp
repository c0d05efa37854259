// SPDX-License-Identifier: MIT
// Messages on their way to the network.
#include "drivers/lcm/send_queue.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <utility>
#include <vector>

namespace unisim::lcm {

// A program that ends does not wait longer for a network than people wait for a program.
constexpr std::chrono::seconds kFarewell(1);

class SendQueue::Shared {
 public:
  Shared(size_t bytes, Send send)
      : bytes_(bytes), out_(bytes / 2), entries_(kMostMessages), send_(std::move(send)) {}

  bool put(const char* channel, size_t size, Writer writer, void* context);
  void send_all();
  void flush();
  /// @return false when the thread is still inside the network
  bool stop();
  SendCounts counts() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return counts_;
  }

 private:
  struct Entry {
    const char* channel;
    size_t at;
    size_t size;
  };

  Entry& entry(size_t i) { return entries_[(first_ + i) % entries_.size()]; }
  void pop() {
    first_ = (first_ + 1) % entries_.size();
    --count_;
  }
  bool place(size_t size, size_t* at);
  void count(int answer, int error_number);

  std::vector<uint8_t> bytes_;  // messages lie whole, one behind the other, around the end
  std::vector<uint8_t> out_;    // the one that is being sent
  std::vector<Entry> entries_;  // a ring
  Send send_;
  size_t first_ = 0;
  size_t count_ = 0;
  bool stopping_ = false;
  bool ended_ = false;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  SendCounts counts_;
};

/// Where `size` bytes are free now.
bool SendQueue::Shared::place(size_t size, size_t* at) {
  if (count_ == entries_.size()) return false;
  *at = 0;
  if (count_ == 0) return true;
  const size_t oldest = entry(0).at;
  const Entry& newest = entry(count_ - 1);
  const size_t end = newest.at + newest.size;
  if (newest.at >= oldest) {
    const bool behind = end + size <= bytes_.size();
    if (behind) *at = end;
    return behind || size <= oldest;
  }
  *at = end;
  return end + size <= oldest;
}

bool SendQueue::Shared::put(const char* channel, size_t size, Writer writer, void* context) {
  if (size > out_.size()) return false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    size_t at = 0;
    while (!place(size, &at)) {
      pop();
      ++counts_.dropped;
    }
    writer(context, bytes_.data() + at);
    entry(count_) = {channel, at, size};
    ++count_;
    ++counts_.queued;
  }
  changed_.notify_all();
  return true;
}

void SendQueue::Shared::count(int answer, int error_number) {
  if (answer == 0) {
    ++counts_.sent;
    return;
  }
  ++counts_.failed;
  counts_.error_number = error_number;
}

void SendQueue::Shared::send_all() {
  std::unique_lock<std::mutex> lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return stopping_ || count_ > 0; });
    if (count_ == 0) break;
    const Entry next = entry(0);
    std::memcpy(out_.data(), bytes_.data() + next.at, next.size);
    pop();
    lock.unlock();
    errno = 0;
    const int answer = send_(next.channel, out_.data(), next.size);
    const int error_number = errno;
    lock.lock();
    count(answer, error_number);
    if (count_ == 0) changed_.notify_all();
  }
  ended_ = true;
  changed_.notify_all();
}

void SendQueue::Shared::flush() {
  std::unique_lock<std::mutex> lock(mutex_);
  const auto all_gone = [this] {
    return counts_.sent + counts_.failed + counts_.dropped == counts_.queued;
  };
  changed_.wait_for(lock, kFarewell, all_gone);
}

bool SendQueue::Shared::stop() {
  std::unique_lock<std::mutex> lock(mutex_);
  stopping_ = true;
  changed_.notify_all();
  if (changed_.wait_for(lock, kFarewell, [this] { return ended_; })) return true;
  counts_.dropped += static_cast<int64_t>(count_);
  count_ = 0;
  return false;
}

SendQueue::SendQueue(size_t bytes, Send send)
    : shared_(std::make_shared<Shared>(bytes, std::move(send))),
      thread_([shared = shared_] { shared->send_all(); }) {}

SendQueue::~SendQueue() {
  if (shared_->stop())
    thread_.join();
  else
    thread_.detach();
}

bool SendQueue::put_with(const char* channel, size_t size, Writer writer, void* context) {
  return shared_->put(channel, size, writer, context);
}

void SendQueue::flush() { shared_->flush(); }

SendCounts SendQueue::counts() const { return shared_->counts(); }

}  // namespace unisim::lcm
