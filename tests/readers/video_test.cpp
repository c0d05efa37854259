// SPDX-License-Identifier: MIT
// Video files.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "tests/readers/playback.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"

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

// What only another program writes. "" without ffmpeg, or where it cannot.
std::string ffmpeg(const TempFolder& folder, const std::string& input, const std::string& how,
                   const std::string& name, const std::string& before = "") {
  const std::string path = folder / name;
  const std::string line = "ffmpeg -v quiet -nostdin -y " + before + " -i '" + input + "' " + how +
                           " '" + path + "' </dev/null";
  return std::system(line.c_str()) == 0 ? path : "";
}

#define REQUIRE_FFMPEG(path)                  \
  if ((path).empty()) {                       \
    WARN("skipped: no ffmpeg for this file"); \
    return;                                   \
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

TEST_CASE("video: range, rate and frames that are not decoded") {
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
  REQUIRE(source->next_frame(source.get(), 1, &frame) == UNISIM_FRAME_OK);
  REQUIRE(frame.index == 11);
  REQUIRE(std::abs(frame.image.data[0] - 55) <= 3);
  REQUIRE(play(source).size() == 1);
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

TEST_CASE("video: pixels that are not square become square, whatever the container") {
  const std::string ending = GENERATE("mp4", "mkv", "avi");
  const TempFolder folder;
  const std::string clip = write_video(folder);
  REQUIRE_VIDEO(clip);
  const std::string wide =
      ffmpeg(folder, clip, "-vf setsar=3/2 -c:v mpeg4 -q:v 2", "wide." + ending);
  REQUIRE_FFMPEG(wide);
  const Source source = open_sequence(wide);
  CHECK(has(notes_of(source), "3:2"));
  CHECK(has(notes_of(source), "96x48"));
  const auto answers = play(source);
  REQUIRE(answers.size() == kFrames);
  CHECK(answers[20].image.width == 96);
  CHECK(answers[20].image.height == 48);
  CHECK(std::abs(answers[20].pixel - 100) <= 6);
  const std::string high = ffmpeg(folder, clip, "-vf setsar=2/3 -c:v mpeg4", "high.mp4");
  CHECK(play(open_sequence(high))[0].image.width == 43);
}

TEST_CASE("video: a turned camera's pixels are stretched along its own rows") {
  const TempFolder folder;
  const std::string clip = write_video(folder);
  REQUIRE_VIDEO(clip);
  const std::string wide = ffmpeg(folder, clip, "-vf setsar=3/2 -c:v mpeg4", "wide.mp4");
  REQUIRE_FFMPEG(wide);
  // Releases of ffmpeg differ in how they are asked for it.
  std::string turned = ffmpeg(folder, wide, "-c copy", "turned.mp4", "-display_rotation 90");
  if (turned.empty()) turned = ffmpeg(folder, wide, "-c copy -metadata:s:v:0 rotate=90", "old.mp4");
  REQUIRE_FFMPEG(turned);
  const auto answers = play(open_sequence(turned));
  CHECK(answers[0].image.width == 48);
  CHECK(answers[0].image.height == 96);
}

TEST_CASE("video: nearly square pixels are left as they are") {
  const TempFolder folder;
  const std::string clip = write_video(folder);
  REQUIRE_VIDEO(clip);
  const std::string nearly = ffmpeg(folder, clip, "-vf setsar=2000/1999 -c:v mpeg4", "nearly.mp4");
  REQUIRE_FFMPEG(nearly);
  const Source source = open_sequence(nearly);
  CHECK(notes_of(source).empty());
  CHECK(play(source)[0].image.width == 64);
}

TEST_CASE("video: a part cut out without encoding again is not called cut off") {
  const std::string ending = GENERATE("mp4", "mov", "mkv", "avi");
  const TempFolder folder;
  const std::string clip = write_video(folder);
  REQUIRE_VIDEO(clip);
  const std::string whole = ffmpeg(
      folder, clip, "-c:v mpeg4 -g 100 -sc_threshold 1000000000 -bf 2 -q:v 2", "whole." + ending);
  REQUIRE_FFMPEG(whole);
  for (const char* part : {"-ss 0.8", "-ss 0.5 -to 1.2"}) {
    CAPTURE(ending, part);
    const auto answers =
        play(open_sequence(ffmpeg(folder, whole, "-c copy", "part." + ending, part)));
    REQUIRE(answers.size() >= 10);
    for (const Answer& answer : answers) CHECK(answer.message.empty());
  }
}

TEST_CASE("video: what is damaged or missing at the end of a file is said") {
  const std::string ending = GENERATE("mp4", "mkv");
  const TempFolder folder;
  const std::string clip = write_video(folder);
  REQUIRE_VIDEO(clip);
  const std::string whole =
      ffmpeg(folder, clip, "-c:v mjpeg -q:v 2 -movflags +faststart", "whole." + ending);
  REQUIRE_FFMPEG(whole);
  std::filesystem::resize_file(whole, std::filesystem::file_size(whole) * 6 / 10);
  const auto answers = play(open_sequence(whole));
  REQUIRE(answers.size() > 10);
  CHECK(has(answers.back().message, "40 frames were announced: file cut off"));
}

TEST_CASE("video: frames have the times of the file where these are uneven, to the last one") {
  const TempFolder folder;
  const std::string clip = write_video(folder);
  REQUIRE_VIDEO(clip);
  const std::string uneven =
      ffmpeg(folder, clip,
             "-vf \"setpts='if(lt(N,20),N/20,1+(N-20)/5)/TB+0.5'\" -fps_mode vfr -c:v "
             "mpeg4 -bf 2",
             "uneven.mp4");
  REQUIRE_FFMPEG(uneven);
  const auto answers = play(open_sequence(uneven));
  REQUIRE(answers.size() == kFrames);
  for (size_t k = 0; k < kFrames; ++k) {
    const double expected =
        k < 20 ? static_cast<double>(k) / 20 : 1 + (static_cast<double>(k) - 20) / 5;
    CHECK(static_cast<double>(answers[k].timestamp_ns) * 1e-9 == Approx(expected).margin(0.002));
  }
}
