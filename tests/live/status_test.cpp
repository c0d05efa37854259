// SPDX-License-Identifier: MIT
// What the status line of a live run is made of.
#include <filesystem>
#include <fstream>

#include "tests/support/catch.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/text.hpp"
#include "tools/live/figures.hpp"
#include "tools/live/options.hpp"
#include "tools/live/pose_age.hpp"
#include "tools/live/status_text.hpp"

using namespace unisim::live;
using unisim::pipeline::LivePose;

namespace {

constexpr int64_t kMs = 1000000;

}  // namespace

TEST_CASE("the age of a pose is measured from its stamp where the stamps' clock is known") {
  PoseAge ages;
  constexpr int64_t kOffset = 5000 * kMs;
  ages.set_stamp_clock(kOffset);
  for (int k = 0; k < 10; ++k) {
    ages.on_live_pose(LivePose{monotonic_ns() + kOffset - 80 * kMs, {}, -1});
  }
  CHECK(ages.ages().percentile_ms(0.5) >= 78.0);
  CHECK(ages.ages().percentile_ms(0.0) < 100.0 + ages.ages().max_ms());
}

TEST_CASE("without the clock the frame that came soonest after its stamp counts as new") {
  PoseAge ages;
  const int64_t now = monotonic_ns();
  ages.on_live_pose(LivePose{now - 500 * kMs, {}, -1});
  ages.on_live_pose(LivePose{now - 700 * kMs, {}, -1});
  CHECK(ages.ages().max_ms() >= 200.0);
}

TEST_CASE("the line says why there is no start, and whether lengths are metres") {
  const PoseAge ages;
  StatusText line(&ages);
  unisim::pipeline::Progress progress;
  progress.state = UNISIM_STATE_INIT;
  progress.reason = UNISIM_REASON_STILL;
  CHECK(has(line(progress), "init (no start yet: not enough motion)"));
  CHECK(has(line(progress), ", relative"));
  progress.metre = {0.5, 0.02};
  CHECK(has(line(progress), ", metric +- 2 % (1 unit = 0.5 m)"));
}

TEST_CASE("the line has what waits, what was given up and what the map is made of") {
  const PoseAge ages;
  StatusText line(&ages);
  unisim::pipeline::Progress progress;
  progress.frames_waiting = 1;
  progress.frames_dropped = 23;
  progress.keyframes = 45;
  progress.submaps = 6;
  progress.loops = 7;
  CHECK(has(line(progress), "1 waiting, 23 dropped, 45 keyframes, 6 submaps, 7 loops, "));
}

TEST_CASE("the warmest zone of a board is its temperature, a board without zones has none") {
  const TempFolder folder;
  CHECK(temperature_c(folder / "absent") < 0.0);
  for (const char* zone : {"zone0", "zone1", "zone2"}) {
    std::filesystem::create_directory(folder / zone);
  }
  std::ofstream(folder / "zone0/temp") << "41000\n";
  std::ofstream(folder / "zone1/temp") << "63500\n";
  std::ofstream(folder / "zone2/temp") << "no number\n";
  CHECK(temperature_c(folder / "") == Approx(63.5));
}

TEST_CASE("cameras and recordings are told apart by what they are called") {
  for (const char* camera : {"", "0", "12", "/dev/video3", "usb-0000:00:14.0-1"}) {
    CHECK(is_camera(camera));
  }
  for (const char* recording : {"video.mp4", "data/rgb", "./0", "dev/video0"}) {
    CHECK_FALSE(is_camera(recording));
  }
}
