// SPDX-License-Identifier: MIT
// From the tracking to those who look at the page.
#include "tools/live/web/feed.hpp"

#include <chrono>
#include <new>
#include <opencv2/core.hpp>
#include <utility>

#include "tools/live/scheduling.hpp"

namespace unisim::live::web {
namespace {

using Clock = std::chrono::steady_clock;

// Between two events of the state. As long as the tracking is silent, too: the page shows that.
constexpr std::chrono::milliseconds kStatusPeriod(500);

}  // namespace

Feed::Feed(const std::string& source) : text_(source), thread_([this] { loop(); }) {}

Feed::~Feed() {
  close();
  {
    const std::lock_guard<std::mutex> lock(slot_mutex_);
    stopping_ = true;
  }
  slot_changed_.notify_all();
  thread_.join();
}

void Feed::offer(View* view) {
  std::unique_lock<std::mutex> lock(slot_mutex_, std::try_to_lock);
  if (!lock.owns_lock()) return;
  std::swap(slot_, *view);
  slot_full_ = true;
  lock.unlock();
  slot_changed_.notify_one();
}

void Feed::loop() {
  give_way();
  View view;
  Clock::time_point next_status{};
  Clock::time_point newest = Clock::now();
  std::unique_lock<std::mutex> lock(slot_mutex_);
  for (;;) {
    slot_changed_.wait_for(lock, kStatusPeriod, [this] { return slot_full_ || stopping_; });
    if (stopping_) return;
    const bool fresh = std::exchange(slot_full_, false);
    if (fresh) std::swap(slot_, view);
    lock.unlock();
    const Clock::time_point now = Clock::now();
    if (fresh) newest = now;
    if (fresh) tell(view);
    if (now >= next_status) {
      next_status = now + kStatusPeriod;
      const std::chrono::duration<double> silent = now - newest;
      tell_status(view, silent.count());
    }
    lock.lock();
  }
}

// Where there is no memory for an event the page goes without it: tracking goes on.
void Feed::tell(const View& view) {
  try {
    if (view.has_map) publish(EventKind::kMap, text_.map(view));
    if (view.has_image && watched()) publish(EventKind::kFrame, text_.frame(view));
  } catch (const std::bad_alloc&) {
  } catch (const cv::Exception&) {
  }
}

void Feed::tell_status(const View& view, double silent_s) {
  try {
    publish(EventKind::kStatus, text_.status(view, silent_s));
  } catch (const std::bad_alloc&) {
  }
}

void Feed::publish(EventKind kind, std::string text) {
  auto shared = std::make_shared<const std::string>(std::move(text));
  {
    const std::lock_guard<std::mutex> lock(events_mutex_);
    Event& event = events_[static_cast<size_t>(kind)];
    ++event.number;
    event.text = std::move(shared);
  }
  events_changed_.notify_all();
}

std::shared_ptr<const std::string> Feed::Watcher::next() {
  std::unique_lock<std::mutex> lock(feed_->events_mutex_);
  for (;;) {
    if (feed_->closed_) return nullptr;
    for (size_t kind = 0; kind < kEventKinds; ++kind) {
      const Event& event = feed_->events_[kind];
      if (event.number == had_[kind]) continue;
      had_[kind] = event.number;
      return event.text;
    }
    feed_->events_changed_.wait(lock);
  }
}

void Feed::close() {
  {
    const std::lock_guard<std::mutex> lock(events_mutex_);
    closed_ = true;
  }
  events_changed_.notify_all();
}

}  // namespace unisim::live::web
