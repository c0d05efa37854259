// SPDX-License-Identifier: MIT
// unisim-live on images that another program sends.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <thread>

#include "drivers/sequence/sequence.h"
#include "tests/lcm/child.hpp"
#include "tests/lcm/image_log.hpp"
#include "tests/lcm/own_network.hpp"
#include "tests/lcm/publisher_fixture.hpp"
#include "tests/replay/program.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/text.hpp"

using namespace unisim::testing;
namespace fs = std::filesystem;

namespace {

/// Stamps as rgb.txt has them.
std::string stamp_text(int64_t ns) {
  const std::string fraction = std::to_string(1000000000 + ns % 1000000000);
  return std::to_string(ns / 1000000000) + "." + fraction.substr(1);
}

}  // namespace

TEST_CASE("images that come over LCM are tracked, with the stamps they came with") {
  UNISIM_SKIP_WITHOUT_NETWORK();
  const TempFolder folder;
  Child live({UNISIM_LIVE_PROGRAM, "--device", "lcm://", "--out", folder / "out", "--quiet"});
  const Made made = make_publisher("");
  REQUIRE(made.publisher != nullptr);
  std::set<std::string> sent;
  // What is sent before it listens is not heard: sent until five have been recorded.
  const std::string fifth = folder / "out/recording/rgb/000004.png";
  for (int lap = 0; lap < 200 && !fs::exists(fifth); ++lap) {
    char message[256] = "";
    const LogSource images(
        unisim_sequence_open(small_sequence().c_str(), nullptr, message, sizeof message));
    INFO(message);
    REQUIRE(images != nullptr);
    unisim_frame frame{};
    while (images->next_frame(images.get(), 1, &frame) == UNISIM_FRAME_OK) {
      const int64_t stamp_ns = (int64_t{1000} * lap + frame.index + 1) * 40000000;
      unisim_lcm_publish_image(made.publisher.get(), stamp_ns, &frame.image);
      sent.insert(stamp_text(stamp_ns));
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
  live.send_signal(SIGTERM);
  live.end();
  REQUIRE(fs::exists(fifth));
  std::ifstream list(folder / "out/recording/rgb.txt");
  std::string line;
  int recorded = 0;
  while (std::getline(list, line)) {
    if (line.front() == '#') continue;
    CHECK(sent.count(line.substr(0, line.find(' '))) == 1);
    ++recorded;
  }
  CHECK(recorded >= 5);
}

TEST_CASE("a live run does not listen to itself, and names a URL that is no good") {
  const ProgramResult itself =
      run_program(UNISIM_LIVE_PROGRAM, {"--device", "lcm://", "--lcm", "", "--lcm-images"});
  CHECK(itself.code == 2);
  CHECK(has(itself.err, "its own images"));
  const ProgramResult wrong = run_program(UNISIM_LIVE_PROGRAM, {"--device", "lcm://10.0.0.1:7667"});
  CHECK(wrong.code == 2);
  CHECK(has(wrong.err, "multicast"));
}
