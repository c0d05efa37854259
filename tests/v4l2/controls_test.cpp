// SPDX-License-Identifier: MIT
// Controls are set as asked for, and are at the end what they were.
#include "tests/v4l2/camera_run.hpp"

namespace unisim::test {
namespace {

std::map<uint32_t, FakeControl> webcam() {
  return {{V4L2_CID_EXPOSURE_AUTO, {0, 3, 3, {1, 3}}},
          {V4L2_CID_EXPOSURE_ABSOLUTE, {3, 2047, 250, {}}},
          {V4L2_CID_EXPOSURE_AUTO_PRIORITY, {0, 1, 1, {}}},
          {V4L2_CID_FOCUS_AUTO, {0, 1, 1, {}}},
          {V4L2_CID_FOCUS_ABSOLUTE, {0, 250, 30, {}}},
          {V4L2_CID_POWER_LINE_FREQUENCY, {0, 2, 2, {0, 1, 2}}}};
}

std::map<uint32_t, int32_t> values(const FakeCamera& camera) {
  std::map<uint32_t, int32_t> all;
  for (const auto& [id, control] : camera.controls) all[id] = control.value;
  return all;
}

void ask_for_all(CameraRun* run) {
  make_small(run);
  run->camera->controls = webcam();
  run->config.exposure = UNISIM_V4L2_FIXED;
  run->config.exposure_us = 8000;
  run->config.focus = UNISIM_V4L2_FIXED;
  run->config.focus_position = 12;
  run->config.power_line_hz = 50;
}

}  // namespace

TEST_CASE("controls are set as asked for and put back at the end") {
  CameraRun run;
  ask_for_all(&run);
  const auto before = values(*run.camera);
  REQUIRE(run.open());
  CHECK(run.notes().empty());
  auto now = values(*run.camera);
  CHECK(now[V4L2_CID_EXPOSURE_AUTO] == V4L2_EXPOSURE_MANUAL);
  CHECK(now[V4L2_CID_EXPOSURE_ABSOLUTE] == 80);
  CHECK(now[V4L2_CID_EXPOSURE_AUTO_PRIORITY] == 0);
  CHECK(now[V4L2_CID_FOCUS_AUTO] == 0);
  CHECK(now[V4L2_CID_FOCUS_ABSOLUTE] == 12);
  CHECK(now[V4L2_CID_POWER_LINE_FREQUENCY] == V4L2_CID_POWER_LINE_FREQUENCY_50HZ);
  run.close();
  CHECK(values(*run.camera) == before);
}

TEST_CASE("an automatic takes the mode that the camera has") {
  CameraRun run;
  make_small(&run);
  run.camera->controls = webcam();
  run.camera->controls[V4L2_CID_EXPOSURE_AUTO].value = V4L2_EXPOSURE_MANUAL;
  run.config.exposure = UNISIM_V4L2_AUTO;
  SECTION("aperture priority") {
    REQUIRE(run.open());
    CHECK(values(*run.camera)[V4L2_CID_EXPOSURE_AUTO] == V4L2_EXPOSURE_APERTURE_PRIORITY);
  }
  SECTION("full automatic") {
    run.camera->controls[V4L2_CID_EXPOSURE_AUTO].choices = {0, 1};
    REQUIRE(run.open());
    CHECK(values(*run.camera)[V4L2_CID_EXPOSURE_AUTO] == V4L2_EXPOSURE_AUTO);
  }
  // What the automatic did meanwhile is undone.
  run.camera->controls[V4L2_CID_EXPOSURE_ABSOLUTE].value = 999;
  run.close();
  CHECK(values(*run.camera)[V4L2_CID_EXPOSURE_AUTO] == V4L2_EXPOSURE_MANUAL);
  CHECK(values(*run.camera)[V4L2_CID_EXPOSURE_ABSOLUTE] == 250);
}

TEST_CASE("nothing but the constant rate is touched unasked") {
  CameraRun run;
  make_small(&run);
  run.camera->controls = webcam();
  auto expected = values(*run.camera);
  SECTION("by default") { expected[V4L2_CID_EXPOSURE_AUTO_PRIORITY] = 0; }
  SECTION("when that is not wanted either") { run.config.constant_rate = 0; }
  REQUIRE(run.open());
  CHECK(values(*run.camera) == expected);
}

TEST_CASE("controls are put back when opening fails after they were set") {
  for (const char* call : {"VIDIOC_REQBUFS", "mmap", "VIDIOC_QBUF", "VIDIOC_STREAMON"}) {
    CameraRun run;
    ask_for_all(&run);
    const auto before = values(*run.camera);
    run.io.fail(call, EIO);
    CHECK_FALSE(run.open());
    CHECK(values(*run.camera) == before);
  }
}

TEST_CASE("controls are put back when the source fails, and when it ends after that") {
  CameraRun run;
  ask_for_all(&run);
  const auto before = values(*run.camera);
  REQUIRE(run.open());
  run.io.fail("VIDIOC_DQBUF", EIO, 0, 1 << 30);
  int answers = 0;
  while (run.next() != UNISIM_FRAME_FAILED) REQUIRE(++answers < 20);
  CHECK(values(*run.camera) == before);
}

TEST_CASE("a camera that came back gets them again, and what it had at first at the end") {
  CameraRun run;
  ask_for_all(&run);
  const auto before = values(*run.camera);
  REQUIRE(run.open());
  REQUIRE(run.next() == UNISIM_FRAME_OK);
  run.io.unplug(0);
  // Power is off: it forgets.
  run.camera->controls = webcam();
  run.camera->controls[V4L2_CID_FOCUS_ABSOLUTE].value = 0;
  run.io.plug(1, run.camera);
  REQUIRE(run.next_good());
  CHECK(values(*run.camera)[V4L2_CID_EXPOSURE_ABSOLUTE] == 80);
  CHECK(values(*run.camera)[V4L2_CID_FOCUS_ABSOLUTE] == 12);
  run.close();
  CHECK(values(*run.camera) == before);
}

TEST_CASE("what a camera does not offer, refuses or cannot reach is told and no failure") {
  CameraRun run;
  ask_for_all(&run);
  std::string expected;
  SECTION("not offered") {
    run.camera->controls.erase(V4L2_CID_FOCUS_ABSOLUTE);
    expected = "/dev/video0: does not offer focus position";
  }
  SECTION("refused") {
    run.io.fail("VIDIOC_S_CTRL", EACCES);
    expected = "automatic exposure: VIDIOC_S_CTRL: Permission denied";
  }
  SECTION("out of range") {
    run.config.exposure_us = 1'000'000;
    expected = "goes from 3 to 2047: set to 2047 instead of 10000";
  }
  REQUIRE(run.open());
  REQUIRE(run.notes().size() == 1);
  INFO(run.notes()[0]);
  CHECK(run.notes()[0].find(expected) != std::string::npos);
}

}  // namespace unisim::test
