// SPDX-License-Identifier: MIT
// Once a camera is open its frames take no memory from the heap.
#include "tests/alloc/malloc_counter.hpp"
#include "tests/v4l2/camera_run.hpp"

namespace unisim::test {
namespace {

/// Leaves out what the fake itself takes.
class CountedIo : public FakeIo {
 public:
  int ioctl(int fd, unsigned long request, void* argument) override {
    const int64_t before = heap_calls();
    const int answer = FakeIo::ioctl(fd, request, argument);
    own_ += heap_calls() - before;
    return answer;
  }
  int poll(pollfd* fds, unsigned count, int timeout_ms) override {
    const int64_t before = heap_calls();
    const int answer = FakeIo::poll(fds, count, timeout_ms);
    own_ += heap_calls() - before;
    return answer;
  }
  int64_t heap_calls_outside() const { return heap_calls() - own_; }

 private:
  int64_t own_ = 0;
};

}  // namespace

TEST_CASE("uncompressed frames, good and damaged, make no heap call") {
  for (const uint32_t fourcc : {V4L2_PIX_FMT_GREY, V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_NV12}) {
    CountedIo io;
    auto camera = std::make_shared<FakeCamera>();
    camera->formats = {{fourcc, {{64, 48, {30.0}}}}};
    camera->script = [](FakeFrame* frame) {
      if (frame->sequence % 7 == 3) frame->flags |= V4L2_BUF_FLAG_ERROR;
    };
    io.plug(0, camera);
    unisim_source* source = v4l2::open_camera(io, nullptr, nullptr, nullptr, 0);
    REQUIRE(source != nullptr);
    int64_t count = 0;
    int good = 0;
    for (int i = 0; i < 40; ++i) {
      unisim_frame frame;
      if (i % 5 == 0) io.sleep_ns(100'000'000);
      const int64_t before = io.heap_calls_outside();
      good += source->next_frame(source, 1, &frame) == UNISIM_FRAME_OK ? 1 : 0;
      count += io.heap_calls_outside() - before;
    }
    source->destroy(source);
    CHECK(count == 0);
    CHECK(good > 30);
  }
}

}  // namespace unisim::test
