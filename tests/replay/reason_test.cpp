// SPDX-License-Identifier: MIT
// The reason beside the state in keyframes.csv: what was wrong when a keyframe was taken.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/replay/damaged_sequence.hpp"
#include "tests/replay/program.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"

using namespace unisim::testing;

namespace {

/// Field `name` of the keyframe that frame `frame` became.
std::string field_of(const std::string& table, int frame, const std::string& name) {
  std::istringstream lines(table);
  std::vector<std::string> names;
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> fields;
    std::istringstream parts(line + ",");
    for (std::string part; std::getline(parts, part, ',');) fields.push_back(part);
    if (names.empty()) {
      names = fields;
      continue;
    }
    REQUIRE(fields.size() == names.size());
    const auto at = [&](const std::string& wanted) {
      const auto found = std::find(names.begin(), names.end(), wanted);
      REQUIRE(found != names.end());
      return fields[static_cast<size_t>(found - names.begin())];
    };
    if (at("frame") == std::to_string(frame)) return at(name);
  }
  return "no such keyframe";
}

}  // namespace

TEST_CASE("keyframes.csv says what was wrong when a keyframe was taken, and nothing else") {
  const DamagedSequence sequence;
  for (int k = 48; k < 52; ++k) {
    const cv::Mat covered(240, 320, CV_8UC3, cv::Scalar::all(k - 46));  // no two alike
    REQUIRE(cv::imwrite(sequence.image(static_cast<size_t>(k)), covered));
  }
  const TempFolder folder;
  const std::string out = folder / "out";
  const ProgramResult result = run_replay(arguments(sequence.path(), out));
  INFO(result.err);
  REQUIRE(result.code == 0);
  const std::string table = read_file(out + "/keyframes.csv");
  INFO(table);
  CHECK(field_of(table, 0, "reason") == "no start yet");
  CHECK(field_of(table, 20, "reason").empty());
  CHECK(field_of(table, 20, "state") == "tracking");
  CHECK(field_of(table, 48, "reason") == "covered");
  CHECK(field_of(table, 48, "state") != "tracking");
  CHECK(field_of(table, 76, "reason").empty());
  const auto summary = nlohmann::json::parse(read_file(out + "/summary.json"));
  CHECK(summary.at("frame_reasons").at("covered") == 4);
}
