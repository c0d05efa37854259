// SPDX-License-Identifier: MIT
// --mask: taken where it fits the frames, refused in one line where it does not.
#include <string>
#include <vector>

#include "tests/replay/program.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"

using namespace unisim::testing;

namespace {

/// The left quarter hidden, values 0 and 1.
std::string mask_text(int width, int height) {
  std::string text = "P5 " + std::to_string(width) + " " + std::to_string(height) + " 255\n";
  for (int y = 0; y < height; ++y) {
    text += std::string(static_cast<size_t>(width / 4), '\0');
    text += std::string(static_cast<size_t>(width - width / 4), '\1');
  }
  return text;
}

}  // namespace

TEST_CASE("a mask hides a part of the frames, and one that does not fit is refused") {
  const TempFolder folder;
  const auto run_masked = [&](const std::string& mask, std::vector<std::string> more) {
    write_file(folder / "mask.pgm", mask);
    std::vector<std::string> all = {rendered_sequence(), "--out",  folder / "out",
                                    "--stride",          "4",      "--quiet",
                                    "--force",           "--mask", folder / "mask.pgm"};
    all.insert(all.end(), more.begin(), more.end());
    return run_replay(all);
  };
  const ProgramResult good = run_masked(mask_text(320, 240), {});
  INFO(good.err);
  CHECK(good.code == 0);
  const auto check_refused = [](const ProgramResult& result, int code, const std::string& part) {
    INFO(result.err);
    CHECK(result.code == code);
    CHECK(has(result.err, part));
  };
  check_refused(run_masked(mask_text(160, 120), {}), 3, "160x120");
  check_refused(run_masked("no image", {}), 3, "mask.pgm");
  check_refused(run_masked(mask_text(320, 240), {"--predictor", "recorded", "--predictions", "x"}),
                2, "--mask");
}
