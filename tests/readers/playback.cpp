// SPDX-License-Identifier: MIT
// Writes small sequences and reads them back through the C table.
#include "tests/readers/playback.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <opencv2/imgcodecs.hpp>

#include "tests/support/catch.hpp"

namespace {

unisim_source* open(const std::string& path, const char* format, int64_t from, int64_t to,
                    double fps, std::string* message) {
  unisim_sequence_options options{};
  options.struct_size = sizeof options;
  options.format = format;
  options.from = from;
  options.to = to;
  options.fps = fps;
  char text[1024] = "";
  unisim_source* source = unisim_sequence_open(path.c_str(), &options, text, sizeof text);
  *message = text;
  return source;
}

}  // namespace

Source open_sequence(const std::string& path, const char* format, int64_t from, int64_t to,
                     double fps) {
  std::string message;
  Source source(open(path, format, from, to, fps, &message));
  INFO(message);
  REQUIRE(source != nullptr);
  return source;
}

std::string open_failure(const std::string& path, const char* format, int64_t from, int64_t to) {
  std::string message;
  const Source source(open(path, format, from, to, 0, &message));
  REQUIRE(source == nullptr);
  REQUIRE(message.find('\n') == std::string::npos);
  return message;
}

std::vector<Answer> play(const Source& source, bool decode) {
  std::vector<Answer> answers;
  unisim_frame frame;
  int status = source->next_frame(source.get(), decode ? 1 : 0, &frame);
  while (status != UNISIM_FRAME_END) {
    const int pixel = frame.image.data != nullptr ? frame.image.data[0] : -1;
    const std::string message = status == UNISIM_FRAME_OK ? "" : source->message(source.get());
    answers.push_back({status, frame.index, frame.timestamp_ns, frame.image, pixel, message});
    REQUIRE(status != UNISIM_FRAME_FAILED);
    status = source->next_frame(source.get(), decode ? 1 : 0, &frame);
  }
  REQUIRE(source->next_frame(source.get(), 1, &frame) == UNISIM_FRAME_END);
  return answers;
}

std::vector<unisim_stamped_pose> truth_of(const Source& source) {
  const unisim_stamped_pose* poses = nullptr;
  const int64_t count = source->ground_truth(source.get(), &poses);
  return {poses, poses + count};
}

std::string notes_of(const Source& source) {
  std::string notes;
  for (int32_t i = 0; unisim_sequence_note(source.get(), i) != nullptr; ++i) {
    notes += std::string(unisim_sequence_note(source.get(), i)) + "\n";
  }
  return notes;
}

void write_image(const TempFolder& folder, const std::string& name, int brightness, int width,
                 int height, bool gray) {
  folder.make_parent(name);
  const cv::Mat image(height, width, gray ? CV_8UC1 : CV_8UC3, cv::Scalar::all(brightness));
  REQUIRE(cv::imwrite(folder / name, image));
}

namespace detail {

StderrCapture::StderrCapture() : saved_(dup(STDERR_FILENO)) {
  std::fflush(stderr);
  const int file = ::open((folder_ / "stderr").c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600);
  dup2(file, STDERR_FILENO);
  close(file);
}

StderrCapture::~StderrCapture() {
  std::fflush(stderr);
  dup2(saved_, STDERR_FILENO);
  close(saved_);
}

std::string StderrCapture::text() {
  std::fflush(stderr);
  return read_file(folder_ / "stderr");
}

}  // namespace detail
