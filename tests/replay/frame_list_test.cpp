// SPDX-License-Identifier: MIT
// unisim-replay --list-frames: the frames of a sequence for programs that read the same images.
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/replay/program.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"

using namespace unisim::testing;
using nlohmann::json;

namespace {

std::vector<json> frames_of(const ProgramResult& result) {
  INFO(result.err);
  REQUIRE(result.code == 0);
  std::vector<json> frames;
  std::istringstream lines(result.out);
  for (std::string line; std::getline(lines, line);) frames.push_back(json::parse(line));
  return frames;
}

std::vector<json> list_frames(const std::string& sequence, std::vector<std::string> options = {}) {
  options.insert(options.begin(), {sequence, "--list-frames"});
  return frames_of(run_replay(options));
}

void write_picture(const TempFolder& folder, const std::string& name, int type = CV_8UC1) {
  folder.make_parent(name);
  REQUIRE(cv::imwrite(folder / name, cv::Mat(24, 32, type, cv::Scalar::all(3000))));
}

}  // namespace

TEST_CASE("frames are listed with file, index and time, and nothing is computed") {
  const TempFolder folder;
  for (const char* name : {"rgb/a.png", "rgb/b.png", "rgb/c.png"}) write_picture(folder, name);
  folder.write("rgb.txt", "# time file\n0.5 rgb/b.png\n1.25 rgb/c.png\n2.000000001 rgb/a.png\n");
  const std::vector<json> frames = list_frames(folder.path());
  REQUIRE(frames.size() == 3);
  CHECK(frames[0] == json({{"index", 0},
                           {"time_ns", 500000000},
                           {"time", 0.5},
                           {"format", "tum"},
                           {"file", folder / "rgb/b.png"}}));
  CHECK(frames[2]["time_ns"] == 2000000001);
  CHECK(frames[2]["file"] == folder / "rgb/a.png");
}

TEST_CASE("the list honours format, range and stride") {
  const TempFolder folder;
  for (int k = 0; k < 10; ++k) write_picture(folder, std::to_string(k) + ".png");
  std::vector<int> indices;
  for (const json& frame :
       list_frames(folder.path(), {"--from", "2", "--to", "9", "--stride", "3"})) {
    indices.push_back(frame["index"]);
  }
  CHECK(indices == std::vector<int>{2, 5, 8});
  const ProgramResult other = run_replay({folder.path(), "--list-frames", "--format", "tum"});
  CHECK(other.code == 3);
  CHECK(has(other.err, "rgb.txt"));
}

TEST_CASE("images that are missing are listed, images are not decoded for it") {
  const TempFolder folder;
  folder.write("rgb.txt", "1 a.png\n2 b.png\n");
  CHECK(list_frames(folder.path()).size() == 2);
}

TEST_CASE("the list says what the pixels need") {
  const TempFolder folder;
  write_picture(folder, "deep/0.png", CV_16UC1);
  CHECK(list_frames(folder / "deep")[0]["bits"] == 12);
  write_picture(folder, "plain/0.png");
  const json plain = list_frames(folder / "plain")[0];
  for (const char* name : {"bits", "orientation", "stretched"}) CHECK_FALSE(plain.contains(name));
}

TEST_CASE("a name that is not UTF-8 is listed in whole, as valid JSON") {
  const TempFolder folder;
  write_picture(folder, "caf\xe9.png");
  const json frame = list_frames(folder.path())[0];
  CHECK(frame["file"] == folder / "caf\xef\xbf\xbd.png");
  const std::string hex = frame["file_hex"];
  CHECK(has(hex, "636166e92e706e67"));
}

TEST_CASE("frames of a video are listed with its times") {
  const TempFolder folder;
  const std::string path = folder / "clip.avi";
  cv::VideoWriter writer(path, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 20.0, {64, 48});
  if (!writer.isOpened()) {
    WARN("skipped: this OpenCV writes no video");
    return;
  }
  for (int k = 0; k < 5; ++k) writer.write(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(40 * k)));
  writer.release();
  const std::vector<json> frames = list_frames(path, {"--from", "1"});
  REQUIRE(frames.size() == 4);
  CHECK(frames[1]["index"] == 2);
  CHECK(frames[1]["time_ns"] == 100000000);
  CHECK(frames[1]["format"] == "video");
  CHECK(frames[1]["file"] == path);
}

TEST_CASE("a list of frames goes to stdout alone") {
  const ProgramResult result = run_replay({"somewhere", "--list-frames", "--out", "somewhere"});
  CHECK(result.code == 2);
  CHECK(has(result.err, "--out"));
}
