// SPDX-License-Identifier: MIT
// A camera behind the thread of the pipeline that reads sources.
#include "drivers/pipeline/frame_reader.hpp"
#include "tests/v4l2/camera_run.hpp"

namespace unisim::test {

TEST_CASE("the reader goes on when a camera is lost and comes back, and ends while it waits") {
  CameraRun run;
  make_small(&run);
  REQUIRE(run.open());
  const int64_t start_ns = run.io.now_ns();
  // The clock is the reader's: it goes on as frames are read.
  run.io.at(start_ns + 200'000'000, [&run] { run.io.unplug(0); });
  run.io.at(start_ns + 3'000'000'000, [&run] { run.io.plug(5, run.camera); });
  run.io.at(start_ns + 4'000'000'000, [&run] {
    run.camera->silent = true;
    run.io.unplug(5);
    run.io.plug(6, run.camera);
    run.io.wait_for_real();
  });
  pipeline::FrameReader reader(run.source, 2, true);
  std::vector<std::string> lines;
  int good = 0;
  while (lines.size() < 4) {
    const pipeline::FrameReader::Item* item = reader.next(nullptr, std::chrono::milliseconds(0));
    REQUIRE(item != nullptr);
    REQUIRE((item->status == UNISIM_FRAME_OK || item->status == UNISIM_FRAME_BAD));
    if (item->status == UNISIM_FRAME_OK) {
      ++good;
    } else {
      lines.push_back(item->message);
    }
  }
  CHECK(good > 20);
  CHECK(lines[1].find("/dev/video5: the camera is back") == 0);
  CHECK(lines[3].find("/dev/video6: the camera is back") == 0);
  // No frame will come any more: the reader sits in the source.
  reader.stop();
  CHECK_FALSE(reader.holds_source());
  CHECK(run.statistics().reconnects == 2);
}

}  // namespace unisim::test
