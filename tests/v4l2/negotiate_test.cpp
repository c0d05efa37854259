// SPDX-License-Identifier: MIT
// Which format, size and rate come of a wish, and what is told about it.
#include <limits>

#include "drivers/v4l2/list.hpp"
#include "tests/v4l2/camera_run.hpp"

namespace unisim::test {
namespace {

std::string format_of(const CameraRun& run) { return run.mode().pixel_format; }

bool any_says(const std::vector<std::string>& notes, const std::string& text) {
  for (const std::string& note : notes) {
    if (note.find(text) != std::string::npos) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("the defaults take an uncompressed format at full rate and have nothing to tell") {
  CameraRun run;
  REQUIRE(run.open());
  CHECK(format_of(run) == "GREY");
  CHECK(run.mode().width == 640);
  CHECK(run.mode().height == 480);
  CHECK(run.mode().fps == Approx(30));
  CHECK(std::string(run.mode().device) == "/dev/video0");
  CHECK(std::string(run.mode().bus) == "usb-fake-1");
  CHECK(run.notes().empty());
  CHECK(run.io.calls("VIDIOC_S_PARM") == 1);
}

TEST_CASE("MJPG is taken where uncompressed frames are too slow or too small") {
  CameraRun run;
  run.config.width = 1280;
  run.config.height = 720;
  SECTION("slow") {
    run.camera->formats = {{V4L2_PIX_FMT_YUYV, {{1280, 720, {5.0, 10.0}}}},
                           {V4L2_PIX_FMT_MJPEG, {{1280, 720, {30.0}}}}};
    REQUIRE(run.open());
    CHECK(format_of(run) == "MJPG");
  }
  SECTION("small") {
    run.camera->formats = {{V4L2_PIX_FMT_YUYV, {{640, 480, {30.0}}}},
                           {V4L2_PIX_FMT_MJPEG, {{1280, 720, {15.0}}}}};
    REQUIRE(run.open());
    CHECK(format_of(run) == "MJPG");
    CHECK(any_says(run.notes(), "gives 15 frames per second instead of 30"));
  }
  SECTION("neither: the uncompressed one stays") {
    run.camera->formats = {{V4L2_PIX_FMT_MJPEG, {{1280, 720, {30.0}}}},
                           {V4L2_PIX_FMT_YUYV, {{1280, 720, {29.97}}}}};
    REQUIRE(run.open());
    CHECK(format_of(run) == "YUYV");
  }
}

TEST_CASE("a format that is asked for is taken though it is slower") {
  CameraRun run;
  run.camera->formats = {{V4L2_PIX_FMT_YUYV, {{640, 480, {5.0}}}},
                         {V4L2_PIX_FMT_GREY, {{640, 480, {30.0}}}}};
  run.config.pixel_format = "YUYV";
  REQUIRE(run.open());
  CHECK(format_of(run) == "YUYV");
  CHECK(any_says(run.notes(), "5 frames per second"));
}

TEST_CASE("what is not offered is refused with what is") {
  CameraRun run;
  SECTION("this format") {
    run.config.pixel_format = "NV12";
    CHECK_FALSE(run.open());
    CHECK(run.says("does not offer NV12 but YUYV, GREY"));
  }
  SECTION("none of use") {
    run.camera->formats = {{V4L2_PIX_FMT_SBGGR8, {{640, 480, {30.0}}}}};
    CHECK_FALSE(run.open());
    CHECK(run.says("BA81"));
  }
  CHECK(run.problem == UNISIM_V4L2_NO_CAMERA);
}

TEST_CASE("the nearest size is taken and told") {
  CameraRun run;
  run.camera->formats = {
      {V4L2_PIX_FMT_YUYV, {{160, 120, {30.0}}, {640, 360, {30.0}}, {1920, 1080, {30.0}}}}};
  REQUIRE(run.open());
  CHECK(run.mode().height == 360);
  CHECK(any_says(run.notes(), "/dev/video0: gives 640x360 instead of 640x480"));
  REQUIRE(run.next() == UNISIM_FRAME_OK);
  CHECK(run.frame.image.height == 360);
}

TEST_CASE("a size that the driver changes on its own is read back and told") {
  CameraRun run;
  run.camera->forced_width = 320;
  run.camera->forced_height = 240;
  REQUIRE(run.open());
  CHECK(any_says(run.notes(), "gives 320x240"));
  REQUIRE(run.next() == UNISIM_FRAME_OK);
  CHECK(run.frame.image.width == 320);
}

TEST_CASE("of a range of sizes the one asked for is taken, or the nearest step") {
  CameraRun run;
  run.camera->formats = {{V4L2_PIX_FMT_YUYV, {{32, 32, {1.0, 30.0, 90.0}}, {2592, 1944, {}}}, 4}};
  REQUIRE(run.open());
  CHECK(run.mode().width == 640);
  CHECK(run.mode().height == 480);
  CHECK(run.notes().empty());
  run.close();
  run.config.width = 323;
  run.config.height = 5000;
  REQUIRE(run.open());
  CHECK(run.mode().width == 324);
  CHECK(run.mode().height == 1944);
  CHECK(any_says(run.notes(), "gives 324x1944 instead of 323x5000"));
  CHECK(run.next() == UNISIM_FRAME_OK);
  int32_t cameras = 0;
  CHECK(v4l2::camera_table(run.io, &cameras).find("YUYV  32x32 to 2592x1944 @ 90\n") !=
        std::string::npos);
}

TEST_CASE("a camera that lists neither sizes nor rates is asked for the wish itself") {
  CameraRun run;
  run.camera->lists_sizes = false;
  run.camera->formats = {{V4L2_PIX_FMT_YUYV, {{640, 480, {}}}}};
  REQUIRE(run.open());
  CHECK(run.mode().width == 640);
  CHECK(run.mode().fps == Approx(30));
}

TEST_CASE("a rate that cannot be set is told") {
  CameraRun run;
  run.io.fail("VIDIOC_S_PARM", ENOTTY);
  REQUIRE(run.open());
  CHECK(run.mode().fps == 0);
  CHECK(any_says(run.notes(), "frame rate cannot be set"));
  CHECK(run.next() == UNISIM_FRAME_OK);
}

TEST_CASE("fewer buffers than asked for are enough down to two") {
  CameraRun run;
  make_small(&run);
  run.camera->most_buffers = 2;
  REQUIRE(run.open());
  for (int i = 0; i < 5; ++i) CHECK(run.next() == UNISIM_FRAME_OK);
  run.close();
  run.camera->most_buffers = 1;
  CHECK_FALSE(run.open());
  CHECK(run.says("memory for 1 frames"));
}

TEST_CASE("a configuration that makes no sense is told by its field") {
  CameraRun run;
  const auto refused = [&run](const char* text) {
    const bool opened = run.open();
    INFO(run.message);
    const bool right = !opened && run.problem == UNISIM_V4L2_BAD_CONFIG && run.says(text);
    run.config = camera_config();
    return right;
  };
  run.config.width = 0;
  CHECK(refused("width is 0"));
  run.config.fps = 0;
  CHECK(refused("fps"));
  run.config.fps = std::numeric_limits<double>::quiet_NaN();
  CHECK(refused("fps"));
  run.config.buffers = 2;
  CHECK(refused("buffers is 2"));
  run.config.pixel_format = "RGB3";
  CHECK(refused("'RGB3' cannot be read: give auto, GREY, NV12, YUYV, MJPG"));
  run.config.power_line_hz = 55;
  CHECK(refused("power_line_hz"));
  run.config.exposure = 7;
  CHECK(refused("exposure is 7"));
  run.config.struct_size = 4;
  CHECK(refused("struct_size is 4"));
  CHECK(run.io.calls("open") == 0);
}

TEST_CASE("a node that is no camera is refused in one line") {
  CameraRun run;
  run.config.device = "0";
  run.camera->capabilities = V4L2_CAP_META_CAPTURE | V4L2_CAP_STREAMING;
  CHECK_FALSE(run.open());
  CHECK(run.says("/dev/video0 (Fake Camera) is no camera"));
  run.camera->capabilities = V4L2_CAP_VIDEO_CAPTURE_MPLANE | V4L2_CAP_STREAMING;
  CHECK_FALSE(run.open());
  CHECK(run.says("several planes"));
  run.camera->capabilities = V4L2_CAP_VIDEO_CAPTURE;
  CHECK_FALSE(run.open());
  CHECK(run.says("cannot stream"));
  CHECK(run.problem == UNISIM_V4L2_NO_CAMERA);
}

}  // namespace unisim::test
