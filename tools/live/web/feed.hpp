// SPDX-License-Identifier: MIT
// From the tracking to those who look at the page: the newest of each event, for any number of
// them.
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "tools/live/web/event_text.hpp"
#include "tools/live/web/view.hpp"

namespace unisim::live::web {

/// One slot from the tracking and one for each kind of event: what is newer takes the place of what
/// was not fetched. A thread of its own makes the text of the events, once for all.
class Feed {
 public:
  /// @param source what is tracked, for the page
  explicit Feed(const std::string& source);
  ~Feed();
  Feed(const Feed&) = delete;
  Feed& operator=(const Feed&) = delete;

  /// Somebody looks: images and the map are wanted.
  bool watched() const { return watchers_.load(std::memory_order_relaxed) > 0; }

  /// Exchanges `view` for an older one, whose memory is used again. Never waits: where the slot is
  /// in use, nothing happens.
  void offer(View* view);

  /// One who looks; takes what is newer than what it had.
  class Watcher {
   public:
    explicit Watcher(Feed* feed) : feed_(feed) { ++feed_->watchers_; }
    ~Watcher() { --feed_->watchers_; }
    Watcher(const Watcher&) = delete;
    Watcher& operator=(const Watcher&) = delete;

    /// Waits for the next event. @return NULL after close()
    std::shared_ptr<const std::string> next();

   private:
    Feed* feed_;
    std::array<uint64_t, kEventKinds> had_{};
  };

  int watchers() const { return watchers_.load(); }

  /// Ends all waits, now and later.
  void close();

 private:
  struct Event {
    uint64_t number = 0;
    std::shared_ptr<const std::string> text;
  };

  void loop();
  void tell(const View& view);
  /// @param silent_s seconds since the newest view
  void tell_status(const View& view, double silent_s);
  void publish(EventKind kind, std::string text);

  std::atomic<int> watchers_{0};
  EventText text_;
  std::mutex slot_mutex_;
  std::condition_variable slot_changed_;
  View slot_;
  bool slot_full_ = false;
  bool stopping_ = false;
  std::mutex events_mutex_;
  std::condition_variable events_changed_;
  std::array<Event, kEventKinds> events_;
  bool closed_ = false;
  std::thread thread_;
};

}  // namespace unisim::live::web
