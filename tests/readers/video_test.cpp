// SPDX-License-Identifier: MIT
// Video files.
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "tests/readers/playback.hpp"
#include "tests/support/catch.hpp"

namespace {

constexpr int kFrames = 40;

// Motion JPEG: every frame stands alone. Brightness 5 k; noise keeps the frames from being tiny.
std::string write_video(const TempFolder& folder) {
  const std::string path = folder / "clip.avi";
  cv::VideoWriter writer(path, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 20.0, {64, 48});
  if (!writer.isOpened()) return {};
  for (int k = 0; k < kFrames; ++k) writer.write(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(5 * k)));
  writer.release();
  return path;
}

#define REQUIRE_VIDEO(path)                       \
  if ((path).empty()) {                           \
    WARN("skipped: this OpenCV writes no video"); \
    return;                                       \
  }

}  // namespace

TEST_CASE("video: all frames in order with the times of the file") {
  const TempFolder folder;
  const std::string path = write_video(folder);
  REQUIRE_VIDEO(path);
  const Source source = open_sequence(path);
  REQUIRE(std::string(source->format) == "video");
  REQUIRE(source->frame_count(source.get()) == kFrames);
  const auto answers = play(source);
  REQUIRE(answers.size() == kFrames);
  for (int k = 0; k < kFrames; ++k) {
    const Answer& answer = answers[static_cast<size_t>(k)];
    REQUIRE(answer.status == UNISIM_FRAME_OK);
    REQUIRE(answer.index == k);
    REQUIRE(answer.timestamp_ns == 50000000 * k);
    REQUIRE(std::abs(answer.pixel - 5 * k) <= 3);
  }
}

TEST_CASE("video: range, rate and late decoding") {
  const TempFolder folder;
  const std::string path = write_video(folder);
  REQUIRE_VIDEO(path);
  const Source source = open_sequence(path, "video", 10, 13, 100);
  REQUIRE(source->frame_count(source.get()) == 3);
  unisim_frame frame;
  REQUIRE(source->next_frame(source.get(), 0, &frame) == UNISIM_FRAME_OK);
  REQUIRE(frame.image.data == nullptr);
  REQUIRE(frame.index == 10);
  REQUIRE(frame.timestamp_ns == 100000000);
  REQUIRE(source->decode(source.get(), &frame) == UNISIM_FRAME_OK);
  REQUIRE(std::abs(frame.image.data[0] - 50) <= 3);
  REQUIRE(play(source).size() == 2);
}

TEST_CASE("video: a file cut off gives the frames it has and says so, quietly") {
  const TempFolder folder;
  const std::string path = write_video(folder);
  REQUIRE_VIDEO(path);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  std::vector<Answer> answers;
  const std::string noise = stderr_of([&] { answers = play(open_sequence(path)); });
  REQUIRE(noise.empty());
  REQUIRE(answers.size() > 5);
  REQUIRE(answers.size() < kFrames);
  REQUIRE(answers.front().status == UNISIM_FRAME_OK);
  REQUIRE(answers.back().status == UNISIM_FRAME_BAD);
  REQUIRE(answers.back().message.find("40 frames were announced") != std::string::npos);
}
