// SPDX-License-Identifier: MIT
// Messages on their way to the network: a queue of fixed size and the thread that empties it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <thread>

namespace unisim::lcm {

struct SendCounts {
  int64_t queued = 0;
  int64_t sent = 0;
  int64_t dropped = 0;  ///< the oldest, to make room for newer ones
  int64_t failed = 0;   ///< the network did not take them
  int error_number = 0;
};

/// What is told never waits for the network. put() takes no memory from the heap.
class SendQueue {
 public:
  /// Messages that may wait at once, however small.
  static constexpr size_t kMostMessages = 4096;

  /// What a message is handed to. @return 0 when it went out
  using Send = std::function<int(const char* channel, const void* bytes, size_t size)>;

  /// @param bytes of all messages that wait
  SendQueue(size_t bytes, Send send);
  /// What waits gets up to a second to go out.
  ~SendQueue();
  SendQueue(const SendQueue&) = delete;
  SendQueue& operator=(const SendQueue&) = delete;

  /// Writes a message of `size` bytes, in place. @param channel static text
  /// @param write called once with room for them; must not throw
  /// @return false, with nothing written, when it is larger than half of the queue
  template <typename Write>
  bool put(const char* channel, size_t size, Write write) {
    return put_with(channel, size, &call<Write>, &write);
  }

  /// Waits up to a second for all that is queued to be sent.
  void flush();

  SendCounts counts() const;

 private:
  using Writer = void (*)(void* context, uint8_t* at);
  template <typename Write>
  static void call(void* context, uint8_t* at) {
    (*static_cast<Write*>(context))(at);
  }
  bool put_with(const char* channel, size_t size, Writer writer, void* context);

  class Shared;  // with the thread, which outlives the queue where the network does not come back

  std::shared_ptr<Shared> shared_;
  std::thread thread_;
};

}  // namespace unisim::lcm
