// SPDX-License-Identifier: MIT
// Pixels, and buffers that are not what they should be.
#include <opencv2/imgcodecs.hpp>
#include <thread>

#include "tests/v4l2/camera_run.hpp"

namespace unisim::test {
namespace {

std::vector<uint8_t> jpeg_of(uint32_t n, int32_t width = 64, int32_t height = 48) {
  cv::Mat image(height, width, CV_8UC1, cv::Scalar(static_cast<double>(n % 200 + 20)));
  std::vector<uint8_t> bytes;
  cv::imencode(".jpg", image, bytes);
  return bytes;
}

void make_jpeg_camera(CameraRun* run) {
  run->camera->formats = {{V4L2_PIX_FMT_MJPEG, {{64, 48, {30.0}}}}};
  run->config.width = 64;
  run->config.height = 48;
  run->camera->script = [](FakeFrame* frame) { frame->bytes = jpeg_of(frame->sequence); };
}

}  // namespace

TEST_CASE("gray pixels are those of the camera in every uncompressed format") {
  for (const uint32_t fourcc : {V4L2_PIX_FMT_GREY, V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_NV12}) {
    for (const int32_t padding : {0, 24}) {
      CameraRun run;
      run.camera->formats = {{fourcc, {{64, 48, {30.0}}}}};
      run.camera->row_padding = padding;
      run.config.width = 64;
      run.config.height = 48;
      REQUIRE(run.open());
      for (uint32_t n = 0; n < 6; ++n) {
        REQUIRE(run.next() == UNISIM_FRAME_OK);
        CHECK(run.frame.image.format == UNISIM_PIXEL_GRAY8);
        CHECK(run.frame.image.width == 64);
        CHECK(run.frame.image.height == 48);
        CHECK(run.frame.index == n);
        CHECK(run.shows(n));
      }
    }
  }
}

TEST_CASE("gray frames are given where the kernel put them") {
  CameraRun run;
  make_small(&run);
  REQUIRE(run.open());
  REQUIRE(run.next() == UNISIM_FRAME_OK);
  const uint8_t* first = run.frame.image.data;
  CHECK(run.io.is_mapped(first));
  REQUIRE(run.next() == UNISIM_FRAME_OK);
  CHECK(run.frame.image.data != first);
  // The caller keeps it for a while: the camera may not write there.
  run.io.sleep_ns(1'000'000'000);
  CHECK(run.shows(1));
}

TEST_CASE("without decoding only the time is given") {
  CameraRun run;
  REQUIRE(run.open());
  for (int i = 0; i < 8; ++i) {
    REQUIRE(run.next(0) == UNISIM_FRAME_OK);
    CHECK(run.frame.image.data == nullptr);
    CHECK(run.frame.timestamp_ns > 0);
  }
}

TEST_CASE("MJPG frames are decoded, whatever follows them in the buffer") {
  CameraRun run;
  make_jpeg_camera(&run);
  const auto encode = run.camera->script;
  run.camera->script = [&encode](FakeFrame* frame) {
    encode(frame);
    if (frame->sequence % 2 == 0) frame->bytes.resize(4096, 0xa5);
  };
  REQUIRE(run.open());
  for (uint32_t n = 0; n < 6; ++n) {
    REQUIRE(run.next() == UNISIM_FRAME_OK);
    CHECK(std::abs(run.pixel(31, 20) - static_cast<int>(n + 20)) <= 1);
  }
}

TEST_CASE("a buffer that is no whole JPEG image is passed over with a line") {
  CameraRun run;
  make_jpeg_camera(&run);
  const auto encode = run.camera->script;
  std::string expected;
  SECTION("what was in the buffer before") {
    run.camera->script = [&encode](FakeFrame* frame) {
      encode(frame);
      if (frame->sequence == 0) frame->bytes.assign(6144, 0);
    };
    expected = "no whole JPEG image";
  }
  SECTION("cut off") {
    run.camera->script = [&encode](FakeFrame* frame) {
      encode(frame);
      if (frame->sequence == 0) frame->bytes.resize(frame->bytes.size() / 2);
    };
    expected = "no whole JPEG image";
  }
  SECTION("of another size") {
    run.camera->script = [&encode](FakeFrame* frame) {
      encode(frame);
      if (frame->sequence == 0) frame->bytes = jpeg_of(0, 32, 32);
    };
    expected = "another size";
  }
  REQUIRE(run.open());
  CHECK(run.next() == UNISIM_FRAME_BAD);
  CHECK(run.says("/dev/video0: frame 0: "));
  CHECK(run.says(expected));
  CHECK(run.next() == UNISIM_FRAME_OK);
  CHECK(run.frame.index == 1);
  CHECK(run.statistics().bad == 1);
}

TEST_CASE("damaged and short buffers are counted and passed over") {
  CameraRun run;
  make_small(&run);
  run.camera->script = [](FakeFrame* frame) {
    if (frame->sequence == 2) frame->flags |= V4L2_BUF_FLAG_ERROR;
    if (frame->sequence == 4) frame->bytes.resize(100);
    if (frame->sequence == 5) frame->bytes.clear();
  };
  REQUIRE(run.open());
  std::vector<int> statuses;
  for (int i = 0; i < 7; ++i) statuses.push_back(run.next());
  CHECK(statuses ==
        std::vector<int>{0, 0, UNISIM_FRAME_BAD, 0, UNISIM_FRAME_BAD, UNISIM_FRAME_BAD, 0});
  CHECK(run.frame.index == 6);
  CHECK(run.statistics().errors == 1);
  CHECK(run.statistics().bad == 2);
  CHECK(run.statistics().frames == 4);
}

TEST_CASE("a longer buffer than the image is none the worse for it") {
  CameraRun run;
  make_small(&run);
  run.camera->script = [](FakeFrame* frame) { frame->bytes.resize(32 * 24 + 500); };
  REQUIRE(run.open());
  REQUIRE(run.next() == UNISIM_FRAME_OK);
  CHECK(run.shows(0));
}

TEST_CASE("a frame from before the start and one that comes twice are passed over") {
  CameraRun run;
  make_small(&run);
  int64_t twice_ns = 0;
  run.camera->script = [&twice_ns](FakeFrame* frame) {
    if (frame->sequence == 0) frame->stamp_ns -= 3'000'000'000;
    if (frame->sequence == 3) twice_ns = frame->stamp_ns;
    if (frame->sequence == 4) {
      frame->sequence = 3;
      frame->stamp_ns = twice_ns;
    }
  };
  REQUIRE(run.open());
  CHECK(run.next() == UNISIM_FRAME_BAD);
  CHECK(run.says("before the camera was started"));
  for (int i = 0; i < 3; ++i) CHECK(run.next() == UNISIM_FRAME_OK);
  CHECK(run.next() == UNISIM_FRAME_BAD);
  CHECK(run.says("once more"));
  CHECK(run.next() == UNISIM_FRAME_OK);
}

TEST_CASE("a camera of damaged frames alone is started anew and then given up") {
  CameraRun run;
  make_small(&run);
  run.camera->script = [](FakeFrame* frame) { frame->flags |= V4L2_BUF_FLAG_ERROR; };
  REQUIRE(run.open());
  int answers = 0;
  while (run.next() != UNISIM_FRAME_FAILED) REQUIRE(++answers < 500);
  CHECK(run.says("nothing but damaged frames"));
  CHECK(run.statistics().restarts == 3);
}

TEST_CASE("of frames that are ready the newest is given and the rest counted") {
  CameraRun run;
  make_small(&run);
  REQUIRE(run.open());
  REQUIRE(run.next() == UNISIM_FRAME_OK);
  run.io.sleep_ns(70'000'000);  // two more are there
  REQUIRE(run.next() == UNISIM_FRAME_OK);
  CHECK(run.shows(2));
  CHECK(run.frame.index == 2);
  CHECK(run.statistics().superseded == 1);
  CHECK(run.statistics().lost == 0);
}

TEST_CASE("a damaged newest frame leaves the one before it") {
  CameraRun run;
  make_small(&run);
  run.camera->script = [](FakeFrame* frame) {
    if (frame->sequence == 2) frame->flags |= V4L2_BUF_FLAG_ERROR;
  };
  REQUIRE(run.open());
  REQUIRE(run.next() == UNISIM_FRAME_OK);
  run.io.sleep_ns(70'000'000);
  REQUIRE(run.next() == UNISIM_FRAME_OK);
  CHECK(run.shows(1));
  REQUIRE(run.next() == UNISIM_FRAME_OK);
  CHECK(run.frame.index == 3);
}

TEST_CASE("after a long pause of the caller a fresh frame is waited for") {
  for (const uint32_t fourcc : {V4L2_PIX_FMT_GREY, V4L2_PIX_FMT_YUYV}) {
    CameraRun run;
    make_small(&run);
    run.camera->formats[0].fourcc = fourcc;
    REQUIRE(run.open());
    for (int pause = 0; pause < 3; ++pause) {
      run.io.sleep_ns(5'000'000'000);
      REQUIRE(run.next() == UNISIM_FRAME_OK);
      CHECK(run.io.now_ns() - run.frame.timestamp_ns < 34'000'000);
    }
    CHECK(run.statistics().frames == 3);
  }
}

TEST_CASE("a wait is ended by an interrupt, and so are all later ones") {
  CameraRun run;
  run.camera->silent = true;
  run.io.wait_for_real();
  REQUIRE(run.open());
  std::thread other([&run] { run.source->interrupt(run.source); });
  CHECK(run.next() == UNISIM_FRAME_END);
  other.join();
  CHECK(run.next() == UNISIM_FRAME_END);
}

}  // namespace unisim::test
