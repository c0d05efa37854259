// SPDX-License-Identifier: MIT
// A fake camera opened as a source, for the tests of this folder.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/v4l2/open.hpp"
#include "tests/support/catch.hpp"
#include "tests/v4l2/fake_camera.hpp"

namespace unisim::test {

inline unisim_v4l2_config camera_config() {
  unisim_v4l2_config config;
  unisim_v4l2_config_init(&config, sizeof config);
  return config;
}

/// One fake camera at /dev/video0 and the source over it. Checks at the end that nothing is left
/// open or mapped.
class CameraRun {
 public:
  CameraRun() { io.plug(0, camera); }
  ~CameraRun() {
    close();
    CHECK(io.open_files() == 0);
    CHECK(io.mappings() == 0);
  }
  CameraRun(const CameraRun&) = delete;
  CameraRun& operator=(const CameraRun&) = delete;

  bool open() {
    char text[512] = "";
    source = v4l2::open_camera(io, &config, &problem, text, sizeof text);
    message = text;
    return source != nullptr;
  }
  void close() {
    if (source != nullptr) source->destroy(source);
    source = nullptr;
  }

  /// @return UNISIM_FRAME_*, with frame and message
  int next(int decode = 1) {
    const int status = source->next_frame(source, decode, &frame);
    message =
        status == UNISIM_FRAME_OK || status == UNISIM_FRAME_END ? "" : source->message(source);
    return status;
  }
  /// Passes over bad ones. @return false when there is no more
  bool next_good() {
    int status = UNISIM_FRAME_BAD;
    while (status == UNISIM_FRAME_BAD) status = next();
    return status == UNISIM_FRAME_OK;
  }

  std::vector<std::string> notes() const {
    std::vector<std::string> all;
    for (int32_t i = 0; const char* note = unisim_v4l2_note(source, i); ++i) all.push_back(note);
    return all;
  }
  unisim_v4l2_statistics statistics() const {
    unisim_v4l2_statistics all{};
    all.struct_size = sizeof all;
    unisim_v4l2_get_statistics(source, &all);
    return all;
  }
  unisim_v4l2_mode mode() const {
    unisim_v4l2_mode all{};
    all.struct_size = sizeof all;
    unisim_v4l2_get_mode(source, &all);
    return all;
  }
  uint8_t pixel(int32_t x, int32_t y) const {
    return frame.image.data[static_cast<ptrdiff_t>(y) * frame.image.stride + x];
  }
  /// All pixels are those of the camera's frame n.
  bool shows(uint32_t n) const {
    for (int32_t y = 0; y < frame.image.height; ++y) {
      for (int32_t x = 0; x < frame.image.width; ++x) {
        if (pixel(x, y) != fake_gray(x, y, n)) return false;
      }
    }
    return true;
  }
  bool says(const std::string& text) const { return message.find(text) != std::string::npos; }

  FakeIo io;
  std::shared_ptr<FakeCamera> camera = std::make_shared<FakeCamera>();
  unisim_v4l2_config config = camera_config();
  unisim_source* source = nullptr;
  int32_t problem = 0;
  unisim_frame frame{};
  std::string message;
};

/// A small image for tests that look at many frames.
inline void make_small(CameraRun* run) {
  run->camera->formats = {{V4L2_PIX_FMT_GREY, {{32, 24, {30.0}}}}};
  run->config.width = 32;
  run->config.height = 24;
}

}  // namespace unisim::test
