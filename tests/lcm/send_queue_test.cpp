// SPDX-License-Identifier: MIT
// The queue before the network: order, what is dropped, and that nobody waits.
#include "drivers/lcm/send_queue.hpp"

#include <cerrno>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <string>
#include <vector>

#include "tests/support/catch.hpp"

using unisim::lcm::SendCounts;
using unisim::lcm::SendQueue;

namespace {

/// A network that takes messages only while it is open.
class Gate {
 public:
  int send(const void* bytes, size_t size) {
    std::unique_lock<std::mutex> lock(mutex_);
    ++inside_;
    changed_.notify_all();
    changed_.wait(lock, [this] { return open_; });
    sent_.emplace_back(static_cast<const char*>(bytes), size);
    return 0;
  }
  void open() {
    const std::lock_guard<std::mutex> lock(mutex_);
    open_ = true;
    changed_.notify_all();
  }
  void wait_until_one_is_inside() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return inside_ > 0; });
  }
  std::vector<std::string> sent() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return sent_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool open_ = false;
  int inside_ = 0;
  std::vector<std::string> sent_;
};

bool put(SendQueue* queue, const std::string& text) {
  return queue->put("C", text.size(),
                    [&](uint8_t* at) { std::memcpy(at, text.data(), text.size()); });
}

/// Different lengths, so that the ring wraps everywhere.
std::string message(int k) { return std::to_string(k) + std::string(8 + (k * 37) % 90, '.'); }

}  // namespace

TEST_CASE("messages go out whole and in order") {
  Gate gate;
  gate.open();
  {
    SendQueue queue(1 << 20, [&](const char*, const void* bytes, size_t size) {
      return gate.send(bytes, size);
    });
    for (int k = 0; k < 2000; ++k) REQUIRE(put(&queue, message(k)));
  }
  const std::vector<std::string> sent = gate.sent();
  REQUIRE(sent.size() == 2000);
  for (int k = 0; k < 2000; ++k) REQUIRE(sent[static_cast<size_t>(k)] == message(k));
}

TEST_CASE("a network that does not move holds nobody, and the newest messages wait for it") {
  Gate gate;
  SendCounts counts;
  {
    SendQueue queue(
        1000, [&](const char*, const void* bytes, size_t size) { return gate.send(bytes, size); });
    REQUIRE(put(&queue, message(0)));
    gate.wait_until_one_is_inside();
    for (int k = 1; k < 500; ++k) REQUIRE(put(&queue, message(k)));
    counts = queue.counts();
    CHECK(counts.queued == 500);
    CHECK(counts.dropped > 400);
    gate.open();
  }
  const std::vector<std::string> sent = gate.sent();
  CHECK(static_cast<int64_t>(sent.size()) == 500 - counts.dropped);
  REQUIRE(sent.size() > 2);
  CHECK(sent[0] == message(0));
  // What went out after it are the newest ones, none left out.
  const int rest = static_cast<int>(sent.size()) - 1;
  for (int k = 0; k < rest; ++k) CHECK(sent[static_cast<size_t>(k + 1)] == message(500 - rest + k));
}

TEST_CASE("a message larger than half of the queue is refused") {
  Gate gate;
  gate.open();
  SendQueue queue(
      100, [&](const char*, const void* bytes, size_t size) { return gate.send(bytes, size); });
  CHECK(put(&queue, std::string(50, 'x')));
  CHECK_FALSE(put(&queue, std::string(51, 'x')));
}

TEST_CASE("what the network refuses is counted with its reason") {
  SendCounts counts;
  SendQueue queue(1000, [](const char*, const void*, size_t) {
    errno = ENETUNREACH;
    return -1;
  });
  REQUIRE(put(&queue, "x"));
  do counts = queue.counts();
  while (counts.failed == 0);
  CHECK(counts.sent == 0);
  CHECK(counts.error_number == ENETUNREACH);
}

TEST_CASE("a network that never comes back does not hold the end of the program") {
  // Left to its thread, which outlives the queue.
  auto* gate = new Gate;
  {
    SendQueue queue(1000, [gate](const char*, const void* bytes, size_t size) {
      return gate->send(bytes, size);
    });
    REQUIRE(put(&queue, "x"));
    gate->wait_until_one_is_inside();
  }
  CHECK(gate->sent().empty());
}
