// SPDX-License-Identifier: MIT
// Cameras that are unplugged, come back elsewhere, or stop.
#include "tests/v4l2/camera_run.hpp"

namespace unisim::test {
namespace {

constexpr int64_t kSecond = 1'000'000'000;

void unplug_after_a_frame(CameraRun* run) {
  REQUIRE(run->open());
  REQUIRE(run->next() == UNISIM_FRAME_OK);
  run->io.unplug(0);
}

}  // namespace

TEST_CASE("a camera that is unplugged twenty times is found again by its bus each time") {
  CameraRun run;
  make_small(&run);
  // Another of the same kind is there all the time.
  auto other = std::make_shared<FakeCamera>(*run.camera);
  other->bus = "usb-fake-2";
  run.io.plug(1, other);
  run.config.device = "/dev/video0";
  REQUIRE(run.open());
  int number = 0;
  int64_t last_ns = 0;
  int64_t last_index = -1;
  for (int round = 0; round < 20; ++round) {
    for (int i = 0; i < 3; ++i) {
      REQUIRE(run.next() == UNISIM_FRAME_OK);
      CHECK(run.frame.timestamp_ns > last_ns);
      CHECK(run.frame.index > last_index);
      last_ns = run.frame.timestamp_ns;
      last_index = run.frame.index;
    }
    run.io.unplug(number);
    number = 2 + round % 3;
    run.camera->next_sequence = 0;
    run.io.at(run.io.now_ns() + 2 * kSecond, [&run, number] { run.io.plug(number, run.camera); });
    REQUIRE(run.next() == UNISIM_FRAME_BAD);
    CHECK(run.says("unplugged: waiting 30 s"));
    CHECK(run.io.mappings() == 0);
    REQUIRE(run.next() == UNISIM_FRAME_BAD);
    CHECK(run.says("/dev/video" + std::to_string(number) + ": the camera is back after 2."));
  }
  CHECK(run.statistics().reconnects == 20);
  CHECK(run.statistics().restarts == 0);
  CHECK(other->next_sequence == 0);
}

TEST_CASE("a camera that does not come back ends the source in one line") {
  CameraRun run;
  make_small(&run);
  run.config.reconnect_ms = 5000;
  unplug_after_a_frame(&run);
  const int64_t start_ns = run.io.now_ns();
  CHECK(run.next() == UNISIM_FRAME_BAD);
  CHECK(run.next() == UNISIM_FRAME_FAILED);
  CHECK(run.says("/dev/video0 (Fake Camera on usb-fake-1): did not come back: plug it in"));
  CHECK(run.io.now_ns() - start_ns == Approx(5e9).epsilon(0.01));
}

TEST_CASE("a lost camera is not waited for where that was not asked for") {
  CameraRun run;
  run.config.reconnect_ms = 0;
  unplug_after_a_frame(&run);
  CHECK(run.next() == UNISIM_FRAME_FAILED);
  CHECK(run.says("/dev/video0"));
  CHECK(run.says("plug it in"));
}

TEST_CASE("permissions that come after the device are waited for") {
  CameraRun run;
  make_small(&run);
  unplug_after_a_frame(&run);
  CHECK(run.next() == UNISIM_FRAME_BAD);
  run.io.plug(3, run.camera);
  run.io.fail("open", EACCES, 0, 4);
  CHECK(run.next() == UNISIM_FRAME_BAD);
  CHECK(run.says("back"));
  CHECK(run.next() == UNISIM_FRAME_OK);
}

TEST_CASE("of two nodes of one camera the same one is found again") {
  CameraRun run;
  make_small(&run);
  auto second = std::make_shared<FakeCamera>(*run.camera);
  run.io.plug(1, second);
  run.config.device = "1";
  unplug_after_a_frame(&run);
  run.io.unplug(1);
  CHECK(run.next() == UNISIM_FRAME_BAD);
  run.io.plug(6, run.camera);
  run.io.at(run.io.now_ns() + kSecond, [&run, &second] { run.io.plug(7, second); });
  CHECK(run.next() == UNISIM_FRAME_BAD);
  CHECK(run.says("/dev/video7: the camera is back"));
}

TEST_CASE("a camera that comes back with another size ends the source") {
  CameraRun run;
  make_small(&run);
  unplug_after_a_frame(&run);
  CHECK(run.next() == UNISIM_FRAME_BAD);
  run.camera->forced_width = 16;
  run.camera->forced_height = 16;
  run.io.plug(2, run.camera);
  CHECK(run.next() == UNISIM_FRAME_FAILED);
  CHECK(run.says("/dev/video2: came back with images of 16x16 instead of 32x24"));
}

TEST_CASE("a stream that breaks or stands still is started anew") {
  CameraRun run;
  make_small(&run);
  REQUIRE(run.open());
  REQUIRE(run.next() == UNISIM_FRAME_OK);
  SECTION("an error of the stream") {
    run.camera->broken_stream = true;
    CHECK(run.next() == UNISIM_FRAME_BAD);
    CHECK(run.says("Input/output error"));
  }
  SECTION("no frame comes any more") {
    // The stream that runs has been told already.
    run.camera->script = [](FakeFrame* frame) { frame->never_comes = true; };
    CHECK(run.next() == UNISIM_FRAME_BAD);
    CHECK(run.says("no frame came"));
    run.camera->script = nullptr;
  }
  CHECK(run.next() == UNISIM_FRAME_BAD);
  CHECK(run.says("/dev/video0: started anew"));
  CHECK(run.next() == UNISIM_FRAME_OK);
  CHECK(run.statistics().restarts == 1);
}

TEST_CASE("a camera that gives no frame at all is given up in the end") {
  CameraRun run;
  run.camera->silent = true;
  REQUIRE(run.open());
  int answers = 0;
  while (run.next() != UNISIM_FRAME_FAILED) REQUIRE(++answers < 20);
  CHECK(run.says("no frame came"));
}

TEST_CASE("waiting for a camera ends by an interrupt") {
  CameraRun run;
  REQUIRE(run.open());
  run.io.unplug(0);
  CHECK(run.next() == UNISIM_FRAME_BAD);
  run.io.at(run.io.now_ns() + kSecond, [&run] { run.source->interrupt(run.source); });
  CHECK(run.next() == UNISIM_FRAME_END);
}

TEST_CASE("a camera is found by path, link, number, bus name or by being the first") {
  CameraRun run;
  make_small(&run);
  run.io.unplug(0);
  auto metadata = std::make_shared<FakeCamera>();
  metadata->capabilities = V4L2_CAP_META_CAPTURE | V4L2_CAP_STREAMING;
  run.io.plug(1, metadata);
  run.io.plug(2, run.camera);
  for (const char* device : {"/dev/video2", "2", "usb-fake-1", static_cast<const char*>(nullptr)}) {
    run.config.device = device;
    REQUIRE(run.open());
    CHECK(std::string(run.mode().device) == "/dev/video2");
    run.close();
  }
  run.config.device = "usb-fake-9";
  CHECK_FALSE(run.open());
  CHECK(run.says("usb-fake-9: no camera is on this bus"));
  CHECK(run.problem == UNISIM_V4L2_NO_CAMERA);
  run.io.unplug(2);
  run.config.device = nullptr;
  CHECK_FALSE(run.open());
  CHECK(run.says("no camera is there: plug one in"));
}

}  // namespace unisim::test
