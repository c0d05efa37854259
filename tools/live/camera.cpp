// SPDX-License-Identifier: MIT
// The camera of a live run as a source whose stamps are times of day.
#include "tools/live/camera.hpp"

#include <chrono>
#include <vector>

#include "drivers/common/format.hpp"
#include "tools/common/failure.hpp"
#include "tools/live/pose_age.hpp"

namespace unisim::live {
namespace {

/// Forwards to the camera it owns; stamps are moved by a constant.
struct ClockedSource {
  unisim_source table{};  // first: the pipeline's pointer is ours
  unisim_source* inner = nullptr;
  int64_t offset_ns = 0;
};

ClockedSource* self(unisim_source* source) { return reinterpret_cast<ClockedSource*>(source); }

int next_frame(unisim_source* source, int decode, unisim_frame* frame) {
  ClockedSource* const me = self(source);
  const int status = me->inner->next_frame(me->inner, decode, frame);
  if (status == UNISIM_FRAME_OK) frame->timestamp_ns += me->offset_ns;
  return status;
}

unisim_source* with_time_of_day(unisim_source* camera, int64_t offset_ns) {
  auto* const me = new ClockedSource;
  me->inner = camera;
  me->offset_ns = offset_ns;
  unisim_source& table = me->table;
  table.struct_size = sizeof table;
  table.format = camera->format;
  table.frame_count = [](unisim_source* s) { return self(s)->inner->frame_count(self(s)->inner); };
  table.next_frame = next_frame;
  table.interrupt = [](unisim_source* s) { self(s)->inner->interrupt(self(s)->inner); };
  table.ground_truth = [](unisim_source* s, const unisim_stamped_pose** poses) {
    return self(s)->inner->ground_truth(self(s)->inner, poses);
  };
  table.ground_truth_path = [](unisim_source* s) {
    return self(s)->inner->ground_truth_path(self(s)->inner);
  };
  table.message = [](unisim_source* s) { return self(s)->inner->message(self(s)->inner); };
  table.destroy = [](unisim_source* s) {
    self(s)->inner->destroy(self(s)->inner);
    delete self(s);
  };
  return &table;
}

int exit_code(int32_t problem) {
  switch (problem) {
    case UNISIM_V4L2_BAD_CONFIG:
      return tools::kExitUsage;
    case UNISIM_V4L2_NO_CAMERA:
      return tools::kExitInput;
    default:
      return tools::kExitLimit;
  }
}

}  // namespace

int64_t time_of_day_offset_ns() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count() - monotonic_ns();
}

replay::Input open_camera(const Options& options, int64_t* stamp_clock_offset_ns) {
  unisim_v4l2_config config = options.camera;
  config.device = options.device.empty() ? nullptr : options.device.c_str();
  config.pixel_format = options.pixel_format == "auto" ? nullptr : options.pixel_format.c_str();
  int32_t problem = UNISIM_V4L2_OK;
  char message[1024] = "";
  unisim_source* const camera = unisim_v4l2_open(&config, &problem, message, sizeof message);
  if (camera == nullptr) throw tools::Failure(exit_code(problem), message);
  *stamp_clock_offset_ns = time_of_day_offset_ns();
  replay::Input input;
  unisim_v4l2_mode mode{};
  mode.struct_size = sizeof mode;
  unisim_v4l2_get_mode(camera, &mode);
  input.live_size = replay::FrameSize{mode.width, mode.height};
  input.notes.push_back(drivers::format("%s (%s): %dx%d %s, %.3g frames/s", mode.device, mode.card,
                                        mode.width, mode.height, mode.pixel_format, mode.fps));
  for (int32_t k = 0; unisim_v4l2_note(camera, k) != nullptr; ++k) {
    input.notes.emplace_back(unisim_v4l2_note(camera, k));
  }
  input.source.reset(with_time_of_day(camera, *stamp_clock_offset_ns));
  return input;
}

std::string camera_losses(const unisim_source* source) {
  const auto* const me = reinterpret_cast<const ClockedSource*>(source);
  unisim_v4l2_statistics counts{};
  counts.struct_size = sizeof counts;
  unisim_v4l2_get_statistics(me->inner, &counts);
  std::string text;
  const auto add = [&text](int64_t count, const char* what) {
    if (count == 0) return;
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + what;
  };
  add(counts.lost, "lost by the camera");
  add(counts.superseded, "dropped for newer ones");
  add(counts.errors, "flagged as damaged");
  add(counts.bad, "of no use");
  add(counts.restamped, "with a new time stamp");
  add(counts.restarts, "restarts of the stream");
  add(counts.reconnects, "times plugged in again");
  return text;
}

std::string camera_table() {
  size_t needed = 0;
  unisim_v4l2_list(nullptr, 0, &needed);
  std::vector<char> table(needed + 1);
  if (unisim_v4l2_list(table.data(), table.size(), nullptr) == 0) {
    throw tools::Failure(tools::kExitInput,
                         "no camera found; plug one in, and see with `ls /dev/video*` that the "
                         "system knows it");
  }
  return table.data();
}

}  // namespace unisim::live
