// SPDX-License-Identifier: MIT
// The program: folder layout, options, errors and exit codes.
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <vector>

#include "tests/support/catch.hpp"
#include "tests/support/temp_folder.hpp"

namespace {

namespace fs = std::filesystem;

struct Run {
  int exit_code = 0;
  std::string errors;
};

/// Runs unisim-synth with these arguments; standard output is dropped.
Run synth(const std::string& arguments) {
  const std::string command = UNISIM_SYNTH_PROGRAM " " + arguments + " 2>&1 >/dev/null";
  Run run;
  FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::array<char, 256> buffer{};
  while (std::fgets(buffer.data(), static_cast<int>(buffer.size()), pipe) != nullptr) {
    run.errors += buffer.data();
  }
  const int status = pclose(pipe);
  run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return run;
}

std::vector<std::vector<std::string>> rows_of(const fs::path& path) {
  std::ifstream file(path);
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(file, line);) {
    if (!line.empty() && line[0] != '#') {
      std::istringstream words(line);
      rows.emplace_back();
      for (std::string word; words >> word;) {
        rows.back().push_back(word);
      }
    }
  }
  return rows;
}

const std::string kSmall = " --scene lowtexture --size 96x64 --quiet";

}  // namespace

TEST_CASE("the folder reads as a TUM sequence") {
  const TempFolder folder;
  const fs::path out = folder / "sequence";
  REQUIRE(synth(out.string() + kSmall + " --frames 5 --focal 80").exit_code == 0);
  const auto rgb = rows_of(out / "rgb.txt");
  const auto depth = rows_of(out / "depth.txt");
  const auto pairs = rows_of(out / "associations.txt");
  const auto poses = rows_of(out / "groundtruth.txt");
  REQUIRE(rgb.size() == 5);
  REQUIRE(depth.size() == 5);
  REQUIRE(pairs.size() == 5);
  REQUIRE(poses.size() == 5);
  for (size_t i = 0; i < 5; ++i) {
    CHECK(pairs[i] == std::vector<std::string>{rgb[i][0], rgb[i][1], depth[i][0], depth[i][1]});
    const cv::Mat image = cv::imread((out / rgb[i][1]).string(), cv::IMREAD_UNCHANGED);
    CHECK(image.size() == cv::Size(96, 64));
    CHECK(image.type() == CV_8UC3);
    const cv::Mat distance = cv::imread((out / depth[i][1]).string(), cv::IMREAD_UNCHANGED);
    CHECK(distance.size() == cv::Size(96, 64));
    CHECK(distance.type() == CV_16UC1);
    REQUIRE(poses[i].size() == 8);
    CHECK(poses[i][0] == rgb[i][0]);
    double norm = 0;
    for (size_t k = 4; k < 8; ++k) {
      norm += std::stod(poses[i][k]) * std::stod(poses[i][k]);
    }
    CHECK(norm == Approx(1).epsilon(1e-7));
  }
  CHECK(std::stod(rgb[1][0]) - std::stod(rgb[0][0]) == Approx(1 / 30.0).margin(1e-6));
  const std::string camera = read_file((out / "camera.toml").string());
  CHECK(camera.find("\nfx = 80\n") != std::string::npos);
  CHECK(camera.find("\ncx = 47.5\n") != std::string::npos);
  CHECK(camera.find("\nscene = \"lowtexture\"\n") != std::string::npos);
}

TEST_CASE("a folder that holds something is not written into") {
  const TempFolder folder;
  const std::string out = folder / "sequence";
  REQUIRE(synth(out + kSmall + " --frames 3").exit_code == 0);
  const Run again = synth(out + kSmall + " --frames 2");
  CHECK(again.exit_code == 2);
  CHECK(again.errors.find("--force") != std::string::npos);
  CHECK(rows_of(fs::path(out) / "rgb.txt").size() == 3);
  SECTION("--force replaces an earlier sequence and leaves no frame of it") {
    CHECK(synth(out + kSmall + " --frames 2 --jpg --force").exit_code == 0);
    const fs::directory_iterator images(fs::path(out) / "rgb");
    CHECK(std::distance(fs::begin(images), fs::end(images)) == 2);
  }
  SECTION("--force does not touch a folder of somebody else") {
    fs::remove(fs::path(out) / "camera.toml");
    CHECK(synth(out + kSmall + " --frames 2 --force").exit_code == 2);
    CHECK(rows_of(fs::path(out) / "rgb.txt").size() == 3);
  }
}

TEST_CASE("bad usage is one line that names the option, and exit code 2") {
  const TempFolder folder;
  const std::string out = folder / "sequence";
  const auto [arguments, word] =
      GENERATE(table<std::string, std::string>({{"--size 640", "--size"},
                                                {"--size 640x480x3", "--size"},
                                                {"--size 0x0", "--size"},
                                                {"--size 999999x999999", "--size"},
                                                {"--scene moon", "--scene"},
                                                {"--frames 0", "--frames"},
                                                {"--frames many", "--frames"},
                                                {"--frames 99999999999", "1 to 1000000"},
                                                {"--fps nan", "--fps"},
                                                {"--radial nan", "-0.2 to 0.2"},
                                                {"--seed -1", "--seed"},
                                                {"--threads 1000", "0 to 256"},
                                                {"--focal 1", "--focal"},
                                                {"--fps 0", "--fps"},
                                                {"--loops -7", "--loops"},
                                                {"--radial 3", "--radial"},
                                                {"--encode --noise", "--encode"},
                                                {"--unit-spread 0.3", "--unit-spread"},
                                                {"--encode --unit-spread 1", "--unit-spread"},
                                                {"--unknown", "--unknown"}}));
  const Run run = synth(out + " " + arguments);
  CAPTURE(arguments, run.errors);
  CHECK(run.exit_code == 2);
  CHECK(run.errors.find(word) != std::string::npos);
  CHECK(std::count(run.errors.begin(), run.errors.end(), '\n') == 1);
  CHECK(!fs::exists(out));
}

TEST_CASE("help is no error and a missing folder is one") {
  CHECK(synth("--help").exit_code == 0);
  CHECK(synth("").exit_code == 2);
}

TEST_CASE("a place that cannot be written is exit code 4, a file in the way 2") {
  const TempFolder folder;
  const Run nowhere = synth("/proc/unisim-synth" + kSmall);
  CHECK(nowhere.exit_code == 4);
  CHECK(nowhere.errors.find("/proc/unisim-synth") != std::string::npos);
  std::ofstream(folder / "file") << "x";
  CHECK(synth(folder / "file" + kSmall).exit_code == 2);
}
