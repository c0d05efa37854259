// SPDX-License-Identifier: MIT
// Every error of every system call: survived, or told in one line; nothing stays open.
#include <algorithm>
#include <cerrno>
#include <cstring>

#include "tests/v4l2/camera_run.hpp"

namespace unisim::test {
namespace {

constexpr const char* kCalls[] = {"open",
                                  "close",
                                  "mmap",
                                  "munmap",
                                  "poll",
                                  "eventfd",
                                  "opendir",
                                  "VIDIOC_QUERYCAP",
                                  "VIDIOC_ENUM_FMT",
                                  "VIDIOC_ENUM_FRAMESIZES",
                                  "VIDIOC_ENUM_FRAMEINTERVALS",
                                  "VIDIOC_S_FMT",
                                  "VIDIOC_S_PARM",
                                  "VIDIOC_G_PARM",
                                  "VIDIOC_QUERYCTRL",
                                  "VIDIOC_QUERYMENU",
                                  "VIDIOC_G_CTRL",
                                  "VIDIOC_S_CTRL",
                                  "VIDIOC_REQBUFS",
                                  "VIDIOC_QUERYBUF",
                                  "VIDIOC_QBUF",
                                  "VIDIOC_DQBUF",
                                  "VIDIOC_STREAMON",
                                  "VIDIOC_STREAMOFF"};
constexpr int kErrors[] = {EINTR,  EAGAIN, EIO,    ENODEV, ENXIO,     ENOENT, EBUSY,  EINVAL,
                           ENOMEM, ENOSPC, EACCES, EPERM,  EMFILE,    ENFILE, ENOTTY, EBADF,
                           EFAULT, ERANGE, EPIPE,  EPROTO, ETIMEDOUT, ENOSYS, ENODATA};

void set_up(CameraRun* run) {
  make_small(run);
  run->config.device = "/dev/video0";
  run->camera->controls = {{V4L2_CID_EXPOSURE_AUTO, {0, 3, 3, {1, 3}}},
                           {V4L2_CID_EXPOSURE_ABSOLUTE, {1, 5000, 156, {}}},
                           {V4L2_CID_FOCUS_AUTO, {0, 1, 1, {}}},
                           {V4L2_CID_FOCUS_ABSOLUTE, {0, 250, 30, {}}}};
  run->config.exposure = UNISIM_V4L2_FIXED;
  run->config.exposure_us = 8000;
  run->config.focus = UNISIM_V4L2_FIXED;
}

bool is_one_line(const std::string& text) {
  return !text.empty() && text.find('\n') == std::string::npos;
}

// A list of formats that ends at once is an empty one; what cannot say who it is, is no camera.
std::string expected_text(const std::string& call, int error) {
  const bool end = error == EINVAL || error == ENOTTY || error == ENODATA;
  if (call == "VIDIOC_ENUM_FMT" && end) return "does not offer any of";
  const bool none = call == "VIDIOC_QUERYCAP" && error == EINVAL;
  return ": " + call + ": " + strerrordesc_np(none ? ENOTTY : error) + ": ";
}

// Three whole frames, or a failure with its line.
void read_three(CameraRun* run, bool* all) {
  *all = false;
  for (int good = 0, answers = 0; good < 3; ++answers) {
    REQUIRE(answers < 40);
    const int status = run->next();
    if (status == UNISIM_FRAME_OK) {
      ++good;
      continue;
    }
    REQUIRE(status != UNISIM_FRAME_END);
    INFO(run->message);
    CHECK(is_one_line(run->message));
    CHECK(run->says("/dev/video0"));
    if (status == UNISIM_FRAME_FAILED) {
      CHECK(run->next() == UNISIM_FRAME_FAILED);
      return;
    }
  }
  *all = true;
}

}  // namespace

TEST_CASE("one failure of any call at opening is survived or told in a line that names it") {
  for (const char* call : kCalls) {
    for (const int error : kErrors) {
      for (int nth = 0; nth < 3; ++nth) {
        INFO(call << " " << strerrorname_np(error) << " at call " << nth);
        CameraRun run;
        set_up(&run);
        run.io.fail(call, error, nth);
        bool all = false;
        if (run.open()) {
          read_three(&run, &all);
        } else {
          INFO(run.message);
          CHECK(run.problem != UNISIM_V4L2_OK);
          CHECK(is_one_line(run.message));
          CHECK(run.says(expected_text(call, error)));
        }
        if (error == EINTR && std::strcmp(call, "opendir") != 0 && std::strcmp(call, "mmap") != 0 &&
            std::strcmp(call, "eventfd") != 0) {
          CHECK(all);
        }
      }
    }
  }
}

TEST_CASE("one failure of any call while frames come is survived") {
  for (const char* call : {"poll", "VIDIOC_QBUF", "VIDIOC_DQBUF", "VIDIOC_STREAMOFF", "munmap",
                           "close", "VIDIOC_S_CTRL"}) {
    for (const int error : kErrors) {
      INFO(call << " " << strerrorname_np(error));
      CameraRun run;
      set_up(&run);
      REQUIRE(run.open());
      REQUIRE(run.next() == UNISIM_FRAME_OK);
      run.io.fail(call, error);
      bool all = false;
      read_three(&run, &all);
      CHECK(all);
      if (error == EINTR) CHECK(run.statistics().restarts == 0);
    }
  }
}

TEST_CASE("a call that always fails ends the source with a line") {
  for (const char* call : kCalls) {
    for (const int error : kErrors) {
      if (error == EINTR) continue;
      INFO(call << " " << strerrorname_np(error));
      CameraRun run;
      set_up(&run);
      run.config.reconnect_ms = 1000;
      bool all = false;
      if (run.open()) {
        run.io.fail(call, error, 0, 1 << 30);
        read_three(&run, &all);
      }
      run.close();
      CHECK(run.io.open_files() == 0);
      CHECK(run.io.mappings() == 0);
    }
  }
}

TEST_CASE("the usual reasons come with what to do about them") {
  struct Reason {
    const char* call;
    int error;
    int32_t problem;
    const char* text;
  };
  const Reason reasons[] = {
      {"open", EACCES, UNISIM_V4L2_NOT_ALLOWED, "group video"},
      {"open", ENOENT, UNISIM_V4L2_NO_CAMERA, "plug it in"},
      {"VIDIOC_S_FMT", EBUSY, UNISIM_V4L2_BUSY, "another program has it"},
      {"VIDIOC_REQBUFS", EBUSY, UNISIM_V4L2_BUSY, "another program has it"},
      {"VIDIOC_QUERYCAP", ENOTTY, UNISIM_V4L2_NO_CAMERA, "no camera"},
      {"VIDIOC_STREAMON", ENOSPC, UNISIM_V4L2_FAILED, "USB bandwidth"},
      {"VIDIOC_REQBUFS", ENOMEM, UNISIM_V4L2_FAILED, "fewer buffers"},
  };
  for (const Reason& reason : reasons) {
    CameraRun run;
    run.config.device = "/dev/video0";
    run.io.fail(reason.call, reason.error);
    CHECK_FALSE(run.open());
    INFO(run.message);
    CHECK(run.problem == reason.problem);
    CHECK(run.says("/dev/video0"));
    CHECK(run.says(reason.text));
  }
}

}  // namespace unisim::test
