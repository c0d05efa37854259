// SPDX-License-Identifier: MIT
// Sources that stall, throw and let themselves be interrupted.
#include "drivers/pipeline/frame_reader.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "tests/pipeline/scripted_run.hpp"

using namespace unisim::testing;
using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

namespace {

/// A second on a free machine; these tests also run on loaded ones, and what hangs hangs for ever.
constexpr std::chrono::seconds kSoon(10);

/// Where a source waits until it is let go.
class Gate {
 public:
  void wait() {
    std::unique_lock<std::mutex> lock(mutex_);
    ++waiting_;
    changed_.notify_all();
    changed_.wait(lock, [this] { return open_; });
  }
  void open() {
    const std::lock_guard<std::mutex> lock(mutex_);
    open_ = true;
    changed_.notify_all();
  }
  void wait_for_visitor() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return waiting_ > 0; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool open_ = false;
  int waiting_ = 0;
};

}  // namespace

TEST_CASE("an exception of a source ends the run, not the program") {
  Run run;
  run.source.before_frame = [](int64_t frame) {
    if (frame == 100) throw std::runtime_error("no memory for this image");
  };
  const Result& result = run.go();
  CHECK(result.outcome == Outcome::kSourceFailed);
  CHECK(result.message == "scripted source: no memory for this image");
  CHECK(run.info().posed_keyframes == 20);
}

TEST_CASE("a run is stopped within a second while its source waits") {
  Run run(1000);
  Gate gate;
  run.source.before_frame = [&gate](int64_t frame) {
    if (frame == 60) gate.wait();
  };
  run.source.on_interrupt = [&gate] { gate.open(); };
  Clock::time_point stopped;
  std::thread user([&] {
    gate.wait_for_visitor();
    stopped = Clock::now();
    run.stop.store(true);
  });
  const Result& result = run.go();
  const Clock::duration farewell = Clock::now() - stopped;
  user.join();
  CHECK(result.outcome == Outcome::kStopped);
  CHECK_FALSE(result.source_held);
  CHECK(farewell < kSoon);
  // How far the tracking was behind the reader when it was stopped depends on the machine.
  CHECK(run.predictor.keyframes.size() <= 12);
  CHECK(static_cast<size_t>(run.info().posed_keyframes) == run.predictor.keyframes.size());
}

TEST_CASE("a source that knows no interrupt is left alone with its last call") {
  ScriptedSource source(1000);
  Gate gate;
  source.before_frame = [&gate](int64_t frame) {
    if (frame == 3) gate.wait();
  };
  source.table()->interrupt = nullptr;
  FrameReader reader(source.table(), 8, true);
  std::atomic<bool> stop{false};
  for (int k = 0; k < 3; ++k) REQUIRE(reader.next(&stop, milliseconds(0)) != nullptr);
  gate.wait_for_visitor();
  stop.store(true);
  const Clock::time_point start = Clock::now();
  CHECK(reader.next(&stop, milliseconds(0)) == nullptr);
  reader.stop();
  CHECK(Clock::now() - start < kSoon);
  CHECK(reader.holds_source());
  gate.open();
  while (reader.holds_source()) std::this_thread::sleep_for(milliseconds(1));
}

TEST_CASE("a source that gives nothing for too long has failed") {
  Run run(1000);
  Gate gate;
  run.source.before_frame = [&gate](int64_t frame) {
    if (frame == 60) gate.wait();
  };
  run.source.on_interrupt = [&gate] { gate.open(); };
  run.options.patience_s = 1.0;
  const Result& result = run.go();
  CHECK(result.outcome == Outcome::kSourceFailed);
  CHECK(result.message.find("scripted source: no frame for 1.0 s") == 0);
  CHECK(run.info().posed_keyframes == 12);
}

TEST_CASE("of the frames that wait for a live run the newest comes out") {
  ScriptedSource source(12);
  Gate gate;
  source.before_frame = [&gate](int64_t frame) {
    if (frame == 10) gate.wait();
  };
  FrameReader reader(source.table(), 1, true, FrameReader::Queue::kNewest);
  gate.wait_for_visitor();  // ten frames were read, nobody took one
  const FrameReader::Item* item = reader.next(nullptr, milliseconds(0));
  CHECK(item->status == UNISIM_FRAME_OK);
  CHECK(item->frame.index == 9);
  CHECK(item->made_way == 9);
  const uint8_t* pixels = item->frame.image.data;
  const uint8_t first = pixels[0];
  gate.open();
  while (reader.holds_source()) std::this_thread::sleep_for(milliseconds(1));
  // The frame in hand is not written to; the end of the source is never given up.
  CHECK(item->frame.image.data == pixels);
  CHECK(pixels[0] == first);
  item = reader.next(nullptr, milliseconds(0));
  CHECK(item->status == UNISIM_FRAME_END);
  CHECK(item->made_way == 2);
}

TEST_CASE("a live run counts the frames it has no time for") {
  Run run(400);
  run.options.live = true;
  run.source.before_frame = [](int64_t) { std::this_thread::sleep_for(milliseconds(1)); };
  run.predictor.before_window = [](int32_t) { std::this_thread::sleep_for(milliseconds(20)); };
  const Result& result = run.go();
  CHECK(result.outcome == Outcome::kFinished);
  CHECK(result.progress.frames_dropped > 0);
  CHECK(result.progress.frames + result.progress.frames_dropped == 400);
  CHECK(result.progress.frames == run.predictor.observed);
}
