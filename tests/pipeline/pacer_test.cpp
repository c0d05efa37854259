// SPDX-License-Identifier: MIT
// Recorded times kept in real time: waits end when somebody asks, whatever the times are.
#include "drivers/pipeline/pacer.hpp"

#include <atomic>
#include <chrono>
#include <limits>
#include <thread>

#include "tests/support/catch.hpp"

using unisim::pipeline::Pacer;

namespace {

constexpr int64_t kMillisecond = 1000000;
constexpr int64_t kHour = 3600 * 1000 * kMillisecond;

}  // namespace

TEST_CASE("a frame that is early is waited for, one that is late is dropped") {
  Pacer pacer;
  const auto start = std::chrono::steady_clock::now();
  CHECK(pacer.keep(0, nullptr));
  CHECK(pacer.keep(30 * kMillisecond, nullptr));
  CHECK(std::chrono::steady_clock::now() - start >= std::chrono::milliseconds(30));
  std::this_thread::sleep_until(start + std::chrono::milliseconds(100));
  CHECK_FALSE(pacer.keep(40 * kMillisecond, nullptr));
}

TEST_CASE("the wait for a frame ends when the run is to stop") {
  std::atomic<bool> stop{false};
  Pacer pacer;
  const int64_t pause = GENERATE(values<int64_t>({kHour, std::numeric_limits<int64_t>::max()}));
  CHECK(pacer.keep(0, &stop));
  std::thread other([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    stop = true;
  });
  const auto start = std::chrono::steady_clock::now();
  CHECK(pacer.keep(pause, &stop));
  other.join();
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(5));
}

TEST_CASE("times at the ends of their range have a distance too") {
  constexpr int64_t kFirst = std::numeric_limits<int64_t>::min();
  constexpr int64_t kLast = std::numeric_limits<int64_t>::max();
  std::atomic<bool> stop{true};
  Pacer forwards;
  CHECK(forwards.keep(kFirst, &stop));
  CHECK(forwards.keep(kLast, &stop));  // in 584 years: waited for
  Pacer backwards;
  CHECK(backwards.keep(kLast, &stop));
  CHECK_FALSE(backwards.keep(kFirst, &stop));  // long past: dropped
}
