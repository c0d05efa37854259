// SPDX-License-Identifier: MIT
// What a format's reader finds when it looks through a recorded sequence.
#include "drivers/sequence/recording.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "drivers/sequence/text_file.hpp"

namespace unisim::sequence {

int64_t time_at_rate(int64_t number, double fps) {
  const long double ns = static_cast<long double>(number) * 1e9L / static_cast<long double>(fps);
  if (!(std::abs(ns) <= kMaxTimeNs)) {
    char text[120];
    std::snprintf(text, sizeof text, "frame %lld at %g frames/s is at no time: give a higher rate",
                  static_cast<long long>(number), fps);
    throw InputError(text);
  }
  return std::llround(ns);
}

void read_ground_truth(const std::string& path, PoseFormat format, Recording* recording) {
  try {
    const PoseFile file = read_pose_file(path, format);
    for (const FilePose& pose : file.poses) recording->truth.poses.push_back(to_stamped_pose(pose));
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

void add_note(Recording* recording, const std::string& remark) {
  if (!recording->note.empty()) recording->note += "; ";
  recording->note += remark;
}

}  // namespace unisim::sequence
