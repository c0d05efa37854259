// SPDX-License-Identifier: MIT
// The table of cameras.
#include "drivers/v4l2/list.hpp"

#include "tests/v4l2/camera_run.hpp"

namespace unisim::test {

TEST_CASE("the table names cameras by number, with formats, sizes and rates") {
  CameraRun run;
  run.camera->formats = {{V4L2_PIX_FMT_MJPEG, {{1280, 720, {30.0}}}},
                         {V4L2_PIX_FMT_SBGGR8, {{1280, 720, {30.0}}}},
                         {V4L2_PIX_FMT_YUYV, {{640, 480, {15.0, 30.0}}, {1280, 720, {}}}}};
  auto metadata = std::make_shared<FakeCamera>();
  metadata->capabilities = V4L2_CAP_META_CAPTURE | V4L2_CAP_STREAMING;
  run.io.plug(1, metadata);
  auto raw = std::make_shared<FakeCamera>();
  raw->card = "Raw Camera";
  raw->bus = "platform:isp";
  raw->formats = {{V4L2_PIX_FMT_SBGGR8, {{640, 480, {30.0}}}}};
  run.io.plug(10, raw);
  int32_t cameras = 0;
  const std::string table = v4l2::camera_table(run.io, &cameras);
  CHECK(cameras == 2);
  CHECK(table ==
        "/dev/video0  Fake Camera  usb-fake-1\n"
        "    YUYV  640x480 @ 30, 1280x720\n"
        "    MJPG  1280x720 @ 30\n"
        "/dev/video10  Raw Camera  platform:isp\n"
        "    no format of use here (GREY, NV12, YUYV, MJPG)\n");
}

TEST_CASE("a device that may not be opened has a line in the table that says what to do") {
  CameraRun run;
  run.io.fail("open", EACCES);
  int32_t cameras = -1;
  const std::string table = v4l2::camera_table(run.io, &cameras);
  CHECK(cameras == 0);
  CHECK(table.find("/dev/video0: open: Permission denied: add yourself to group video") == 0);
}

TEST_CASE("the table is cut at a whole line where it does not fit") {
  size_t needed = 0;
  const int32_t cameras = unisim_v4l2_list(nullptr, 0, &needed);
  CHECK(cameras >= 0);
  CHECK(needed >= 1);
  char text[2] = "x";
  CHECK(unisim_v4l2_list(text, sizeof text, nullptr) == cameras);
  CHECK(text[0] == '\0');
}

}  // namespace unisim::test
