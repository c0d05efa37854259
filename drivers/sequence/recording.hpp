// SPDX-License-Identifier: MIT
// What a format's reader finds when it looks through a recorded sequence.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/sequence/pose_file.hpp"
#include "drivers/source.h"

namespace unisim::sequence {

/// One image of a sequence.
struct FrameEntry {
  int64_t timestamp_ns;
  std::string path;
};

/// Ground truth and where it is from.
struct GroundTruth {
  std::vector<unisim_stamped_pose> poses;  ///< by growing time
  std::string path;                        ///< "" if none
  int64_t skipped = 0;                     ///< lines or files left out
};

/// A sequence of image files.
struct Recording {
  std::vector<FrameEntry> frames;
  GroundTruth truth;
  std::string list_path;           ///< where the times are from: a list or a folder
  std::vector<std::string> notes;  ///< what was odd about the listing, a line each
};

/// What the caller asked for.
struct OpenRequest {
  std::string path;
  double fps;           ///< 0: not given
  std::string channel;  ///< of an LCM log, "": not given
};

class FrameSource;

/// Positions [from, to) of a sequence.
struct FrameRange {
  int64_t from;
  int64_t to;
};

/// A format: how it is told apart and how its files are listed.
struct Format {
  const char* name;
  const char* signs;                           ///< what it is recognised by, for messages
  bool (*recognise)(const std::string& path);  ///< may throw InputError
  Recording (*list)(
      const OpenRequest& request);  ///< throws InputError; NULL: not made of image files
  /// Where it is not; throws InputError.
  std::unique_ptr<FrameSource> (*open)(const OpenRequest& request, FrameRange range) = nullptr;
};

extern const Format kTum, kSevenScenes, kEuroc, kKitti, kReplica, kImageList, kLcm, kVideo;

/// @throws InputError when a range begins behind the last of `count` frames
void check_begin(const std::string& path, int64_t count, int64_t from);

/// Times beyond +-292 years do not fit int64_t nanoseconds.
inline constexpr double kMaxTimeNs = 9.2e18;

/// Time of frame `number` at a constant rate, to the nearest nanosecond. @throws InputError beyond
/// kMaxTimeNs
int64_t time_at_rate(int64_t number, double fps);

/// Ground truth from a pose file; an unreadable one leaves it empty, which is noted.
void read_ground_truth(const std::string& path, PoseFormat format, Recording* recording);

/// Sorts the poses by time and notes how many lines were left out.
void finish_ground_truth(Recording* recording);

/// Sorts the frames by time. Repeated lines and images with the time of another are left out, which
/// is noted. @throws InputError when so most images would be
void put_in_time_order(Recording* recording);

/// Notes that times are not in the format's unit.
void note_unit(const std::string& path, TimeUnit unit, Recording* recording);

void add_note(Recording* recording, const std::string& remark);

}  // namespace unisim::sequence
