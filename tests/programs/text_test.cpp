// SPDX-License-Identifier: MIT
// Bytes from outside in JSON, HTML and on a terminal.
#include "tools/common/text.hpp"

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "drivers/common/stamp_text.hpp"
#include "tests/programs/shell.hpp"
#include "tests/support/catch.hpp"
#include "tools/common/json_text.hpp"

using namespace unisim::tools;

namespace {

const std::string kReplaced = "\xEF\xBF\xBD";

}  // namespace

TEST_CASE("text that is UTF-8 stays as it is") {
  const std::string text = "M\xC3\xBCnchen \xE2\x82\xAC \xF0\x9F\x98\x80\n";
  CHECK(valid_utf8(text) == text);
  CHECK(valid_utf8("").empty());
}

TEST_CASE("each byte that is not UTF-8 is replaced") {
  CHECK(valid_utf8("M\xFCnchen") == "M" + kReplaced + "nchen");
  CHECK(valid_utf8("cut \xE2\x82") == "cut " + kReplaced + kReplaced);
  CHECK(valid_utf8("long \xC0\xAF") == "long " + kReplaced + kReplaced);
  CHECK(valid_utf8("\xED\xA0\x80") == kReplaced + kReplaced + kReplaced);
  CHECK(valid_utf8("\xF4\x90\x80\x80").size() == 4 * kReplaced.size());
  CHECK(valid_utf8("\xFF") == kReplaced);
}

TEST_CASE("JSON of any bytes can be parsed") {
  std::string all;
  for (int byte = 0; byte < 256; ++byte) all += static_cast<char>(byte);
  const nlohmann::json parsed = nlohmann::json::parse(json_text({{all, all}}));
  CHECK(parsed.begin().value().get<std::string>().substr(0, 128) == all.substr(0, 128));
}

TEST_CASE("a line for a terminal has no control characters") {
  CHECK(one_line("a\nb\x1B[31mc\x7F") == "a?b?[31mc?");
  CHECK(one_line("\xC2\x9B"
                 "1m M\xC3\xBC") == "?1m M\xC3\xBC");
}

TEST_CASE("a time stamp as text is exact to the nanosecond at any time") {
  using unisim::drivers::stamp_text;
  CHECK(stamp_text(0) == "0.000000000");
  CHECK(stamp_text(1305031102175304001) == "1305031102.175304001");
  CHECK(stamp_text(-1) == "-0.000000001");
  CHECK(stamp_text(INT64_MAX) == "9223372036.854775807");
  CHECK(stamp_text(INT64_MIN) == "-9223372036.854775808");
  using unisim::drivers::stamp_seconds;
  CHECK(stamp_seconds(1305031102175304001) == 1305031102.175304001);
  CHECK(stamp_seconds(-1305031102175304001) == -1305031102.175304001);
  CHECK(stamp_seconds(900000000033333333) == 900000000.033333333);
  CHECK(stamp_seconds(-1) == -1e-9);
}

TEST_CASE("a formatted line is as long as what goes into it") {
  const std::string name(5000, 'x');
  CHECK(unisim::drivers::format("%s: %d", name.c_str(), 7) == name + ": 7");
  CHECK(unisim::drivers::format("%s", "").empty());
}

TEST_CASE("names of files that are not UTF-8 cost no result") {
  unisim::testing::Shell shell;
  const std::string name = "gt\xE4.txt";
  shell.folder().write(name, "0 0 0 0 0 0 0 1\n1 2 0 0 0 0 0 1\n2 2 2 0 0 0 0 1\n");
  shell.folder().write("g\xE4.usg",
                       "node 0 T 1 0 0 0 1 0 0 0 1\nnode 1 T 0 0 0 0 1 1 0.5 0 1\n"
                       "edge v2v 0 1 1 0 0 0 0 1 1 0 0 1\n");
  REQUIRE(shell.run("eval", "ate --json " + name + " " + name + " > out.txt") == 0);
  const nlohmann::json result = nlohmann::json::parse(shell.content("out.txt"));
  CHECK(result.at("protocol").at("estimate").at("file") == "gt" + kReplaced + ".txt");
  REQUIRE(shell.run("bench", "solver --json g\xE4.usg > out.txt") == 0);
  CHECK(nlohmann::json::parse(shell.content("out.txt")).at("graph") == "g" + kReplaced + ".usg");
  REQUIRE(shell.run("eval", "ate --json none\xE4.txt " + name) == 3);
  CHECK(shell.err.find("none" + kReplaced + ".txt") != std::string::npos);
}
