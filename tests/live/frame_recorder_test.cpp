// SPDX-License-Identifier: MIT
// What a live run keeps of its images is a sequence, whole as far as it goes.
#include "tools/live/frame_recorder.hpp"

#include <cstring>
#include <filesystem>
#include <vector>

#include "drivers/sequence/sequence.h"
#include "tests/support/catch.hpp"
#include "tests/support/temp_folder.hpp"
#include "tools/common/failure.hpp"

using unisim::live::FrameRecorder;
namespace fs = std::filesystem;

namespace {

constexpr int32_t kWidth = 40;
constexpr int32_t kHeight = 30;
constexpr int32_t kStride = 64;
constexpr int64_t kFirstNs = 1700000000123456789;

/// Frame `k`, rows with a gap between them.
unisim_frame frame_of(int64_t k, std::vector<uint8_t>* pixels) {
  pixels->assign(static_cast<size_t>(kStride) * kHeight, 255);
  for (int32_t y = 0; y < kHeight; ++y) {
    for (int32_t x = 0; x < kWidth; ++x) {
      (*pixels)[static_cast<size_t>(y * kStride + x)] = static_cast<uint8_t>(3 * x + 5 * y + k);
    }
  }
  return {
      k, kFirstNs + 33333333 * k, {pixels->data(), kWidth, kHeight, kStride, UNISIM_PIXEL_GRAY8}};
}

void record(FrameRecorder* recorder, int64_t from, int64_t to) {
  std::vector<uint8_t> pixels;
  for (int64_t k = from; k < to; ++k) recorder->on_frame(frame_of(k, &pixels));
}

}  // namespace

TEST_CASE("a recording has the pixels and the stamps of its frames") {
  const TempFolder folder;
  FrameRecorder recorder(folder / "run", false);
  record(&recorder, 0, 20);
  CHECK(recorder.finish().empty());
  CHECK(recorder.frames() == 20);
  char message[256] = "";
  unisim_source* source =
      unisim_sequence_open((folder / "run").c_str(), nullptr, message, sizeof message);
  INFO(message);
  REQUIRE(source != nullptr);
  for (int64_t k = 0; k < 20; ++k) {
    unisim_frame read{};
    REQUIRE(source->next_frame(source, 1, &read) == UNISIM_FRAME_OK);
    std::vector<uint8_t> pixels;
    const unisim_frame given = frame_of(k, &pixels);
    REQUIRE(read.timestamp_ns == given.timestamp_ns);
    REQUIRE(read.image.width == kWidth);
    const auto step = static_cast<size_t>(read.image.format);
    for (int32_t y = 0; y < kHeight; ++y) {
      for (int32_t x = 0; x < kWidth; ++x) {
        const uint8_t* row = read.image.data + static_cast<size_t>(y * read.image.stride);
        REQUIRE(row[step * static_cast<size_t>(x)] == pixels[static_cast<size_t>(y * kStride + x)]);
      }
    }
  }
  source->destroy(source);
}

TEST_CASE("a recording that cannot go on is whole up to there, and says so once") {
  const TempFolder folder;
  FrameRecorder recorder(folder / "run", false);
  record(&recorder, 0, 5);
  while (!fs::exists(folder / "run/rgb/000004.png")) std::this_thread::yield();
  fs::rename(folder / "run/rgb", folder / "run/elsewhere");
  record(&recorder, 5, 30);
  const std::string problem = recorder.finish();
  CHECK(problem.find("the recording ends after 5 frames, tracking goes on") != std::string::npos);
  CHECK(recorder.frames() == 5);
  CHECK(recorder.finish() == problem);
}

TEST_CASE("a recording ends while the disk has room for the results of the run") {
  const TempFolder folder;
  FrameRecorder recorder(folder / "run", false, uint64_t{1} << 62);
  record(&recorder, 0, 3);
  const std::string problem = recorder.finish();
  CHECK(
      problem.find("MB left, which are kept for the results; the recording ends after 0 frames") !=
      std::string::npos);
  CHECK(recorder.frames() == 0);
}

TEST_CASE("a recording replaces another one only when asked to") {
  const TempFolder folder;
  std::vector<uint8_t> pixels;
  {
    FrameRecorder first(folder / "run", false);
    record(&first, 0, 3);
  }
  CHECK_THROWS_AS(FrameRecorder(folder / "run", false), unisim::tools::Failure);
  FrameRecorder second(folder / "run", true);
  record(&second, 0, 1);
  CHECK(second.finish().empty());
  CHECK_FALSE(fs::exists(folder / "run/rgb/000001.png"));
}
