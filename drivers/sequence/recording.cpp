// SPDX-License-Identifier: MIT
// What a format's reader finds when it looks through a recorded sequence.
#include "drivers/sequence/recording.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/common/format.hpp"
#include "drivers/common/stamp_text.hpp"
#include "drivers/sequence/folder.hpp"
#include "drivers/sequence/text_file.hpp"

namespace unisim::sequence {

int64_t time_at_rate(int64_t number, double fps) {
  const auto frames = static_cast<double>(number);
  if (!(std::abs(frames / fps) <= kMaxTimeNs / 1e9)) {
    throw InputError(drivers::format("frame %lld at %g frames/s is at no time: give a higher rate",
                                     static_cast<long long>(number), fps));
  }
  // Whole seconds apart: together they would need more digits than a double has.
  const double rest = std::fmod(frames, fps);
  const int64_t seconds = std::llround((frames - rest) / fps);
  return seconds * 1000000000 + std::llround(rest * 1e9 / fps);
}

void check_begin(const std::string& path, int64_t count, int64_t from) {
  if (from < count) return;
  throw InputError(path + ": has " + std::to_string(count) + " frames: the range begins at " +
                   std::to_string(from) + ", begin earlier");
}

void read_ground_truth(const std::string& path, PoseFormat format, Recording* recording) {
  try {
    const PoseFile file = read_pose_file(path, format);
    for (const FilePose& pose : file.poses) recording->truth.poses.push_back(to_stamped_pose(pose));
    if (file.foreign_unit) note_unit(path, file.unit, recording);
    recording->truth.path = path;
    recording->truth.skipped = file.skipped;
  } catch (const InputError& error) {
    add_note(recording, std::string("no ground truth: ") + error.what());
  }
  finish_ground_truth(recording);
}

void finish_ground_truth(Recording* recording) {
  GroundTruth& truth = recording->truth;
  std::stable_sort(truth.poses.begin(), truth.poses.end(),
                   [](const unisim_stamped_pose& a, const unisim_stamped_pose& b) {
                     return a.timestamp_ns < b.timestamp_ns;
                   });
  if (truth.skipped > 0) {
    add_note(recording, truth.path + ": " + std::to_string(truth.skipped) +
                            " poses left out of the ground truth: not numbers or not a pose");
  }
}

void put_in_time_order(Recording* recording) {
  std::vector<FrameEntry>& frames = recording->frames;
  const auto before = [](const FrameEntry& a, const FrameEntry& b) {
    return a.timestamp_ns < b.timestamp_ns;
  };
  if (!std::is_sorted(frames.begin(), frames.end(), before)) {
    add_note(recording, recording->list_path + ": not in the order of time: sorted");
    std::stable_sort(frames.begin(), frames.end(), before);
  }
  std::vector<FrameEntry> kept;
  size_t repeated = 0;
  size_t clashing = 0;
  std::string first;
  for (FrameEntry& frame : frames) {
    if (kept.empty() || before(kept.back(), frame)) {
      kept.push_back(std::move(frame));
    } else if (kept.back().path == frame.path) {
      ++repeated;
    } else if (clashing++ == 0) {
      first = base_name(kept.back().path) + " and " + base_name(frame.path) + " at " +
              drivers::stamp_text(frame.timestamp_ns) + " s";
    }
  }
  const std::string clash = recording->list_path + ": " + std::to_string(clashing) + " of " +
                            std::to_string(clashing + kept.size()) +
                            " images have the time of another (first: " + first + ")";
  if (clashing > kept.size()) {
    throw InputError(clash +
                     ": give each image a time of its own: nanoseconds, or seconds with "
                     "decimals");
  }
  if (clashing > 0) add_note(recording, clash + ": left out");
  if (repeated > 0) {
    add_note(recording,
             recording->list_path + ": " + std::to_string(repeated) + " repeated lines left out");
  }
  frames = std::move(kept);
}

void note_unit(const std::string& path, TimeUnit unit, Recording* recording) {
  add_note(recording, path + ": times are read as " + unit_name(unit));
}

void add_note(Recording* recording, const std::string& remark) {
  recording->notes.push_back(remark);
}

}  // namespace unisim::sequence
