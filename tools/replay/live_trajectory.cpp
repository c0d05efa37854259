// SPDX-License-Identifier: MIT
// trajectory_live.tum: grows as the run goes on and can be read at any time.
#include "tools/replay/live_trajectory.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "drivers/common/format.hpp"
#include "drivers/pipeline/metre_book.hpp"
#include "tools/replay/pose_files.hpp"

namespace unisim::replay {

LiveTrajectory::~LiveTrajectory() {
  if (file_ >= 0) ::close(file_);
}

void LiveTrajectory::on_live_pose(const pipeline::LivePose& pose) {
  if (file_ < 0 && problem_.empty()) {
    file_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (file_ < 0) problem_ = std::strerror(errno);
    append(trajectory_header("poses as first given out", 0.0));
  }
  tell_metre(pose.metre);
  append(trajectory_line({pose.timestamp_ns, pose.T_world_cam}));
}

void LiveTrajectory::tell_metre(const pipeline::Metre& metre) {
  if (!pipeline::differs(metre, told_)) return;
  told_ = metre;
  append(metre.per_unit > 0.0
             ? drivers::format("# from here on 1 unit = %.9g m, known to %.2g %%\n", metre.per_unit,
                               100.0 * metre.sigma)
             : "# from here on the unit is arbitrary\n");
}

/// All of the text or none of it: half a line would be read as another pose.
void LiveTrajectory::append(const std::string& text) {
  if (!problem_.empty()) return;
  const off_t begin = ::lseek(file_, 0, SEEK_END);
  size_t done = 0;
  while (done < text.size() && problem_.empty()) {
    const ssize_t count = ::write(file_, text.data() + done, text.size() - done);
    if (count > 0)
      done += static_cast<size_t>(count);
    else if (errno != EINTR)
      problem_ = std::strerror(errno);
  }
  if (!problem_.empty() && ::ftruncate(file_, begin) != 0) problem_ += "; its last line is cut off";
}

}  // namespace unisim::replay
