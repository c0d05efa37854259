// SPDX-License-Identifier: MIT
// A recording that plays the camera of a live run.
#include "tools/live/played_camera.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <utility>

#include "tools/live/pose_age.hpp"

namespace unisim::live {
namespace {

struct PlayedCamera {
  unisim_source table{};  // first: the pipeline's pointer is ours
  drivers::SourcePtr recording;
  int64_t time_of_day_ns = 0;
  bool started = false;
  int64_t clock_ns = 0;  // CLOCK_MONOTONIC minus the recording's stamps

  std::mutex mutex;
  std::condition_variable woken;
  bool interrupted = false;

  /// @return false when the run ends before
  bool wait_until(int64_t due_ns) {
    std::unique_lock<std::mutex> lock(mutex);
    const std::chrono::steady_clock::time_point due{std::chrono::nanoseconds(due_ns)};
    return !woken.wait_until(lock, due, [this] { return interrupted; });
  }
};

PlayedCamera* self(unisim_source* source) { return reinterpret_cast<PlayedCamera*>(source); }

int next_frame(unisim_source* source, int decode, unisim_frame* frame) {
  PlayedCamera* const me = self(source);
  const int status = me->recording->next_frame(me->recording.get(), decode, frame);
  if (status != UNISIM_FRAME_OK) return status;
  if (!me->started) me->clock_ns = monotonic_ns() - frame->timestamp_ns;
  me->started = true;
  const int64_t due_ns = frame->timestamp_ns + me->clock_ns;
  frame->timestamp_ns = due_ns + me->time_of_day_ns;
  return me->wait_until(due_ns) ? UNISIM_FRAME_OK : UNISIM_FRAME_END;
}

void interrupt(unisim_source* source) {
  PlayedCamera* const me = self(source);
  {
    const std::lock_guard<std::mutex> lock(me->mutex);
    me->interrupted = true;
  }
  me->woken.notify_all();
}

}  // namespace

drivers::SourcePtr play_as_camera(drivers::SourcePtr recording, int64_t time_of_day_ns) {
  auto* const me = new PlayedCamera;
  unisim_source& table = me->table;
  table.struct_size = sizeof table;
  table.format = recording->format;
  table.frame_count = [](unisim_source*) -> int64_t { return -1; };
  table.next_frame = next_frame;
  table.interrupt = interrupt;
  table.ground_truth = [](unisim_source*, const unisim_stamped_pose** poses) -> int64_t {
    *poses = nullptr;  // its stamps are not ours
    return 0;
  };
  table.ground_truth_path = [](unisim_source*) { return ""; };
  table.message = [](unisim_source* s) {
    return self(s)->recording->message(self(s)->recording.get());
  };
  table.destroy = [](unisim_source* s) { delete self(s); };
  me->recording = std::move(recording);
  me->time_of_day_ns = time_of_day_ns;
  return drivers::SourcePtr(&table);
}

}  // namespace unisim::live
