// SPDX-License-Identifier: MIT
// Command lines: help on stdout, mistakes in one line.
#include "tools/common/command_line.hpp"

#include <CLI/CLI.hpp>
#include <sstream>
#include <string>

#include "tools/common/failure.hpp"
#include "tools/common/output.hpp"

namespace unisim::tools {

bool parse(CLI::App* app, int argc, const char* const* argv) {
  try {
    app->parse(argc, argv);
    return true;
  } catch (const CLI::Success& success) {
    std::ostringstream answer;
    app->exit(success, answer, answer);
    print(answer.str());
    return false;
  } catch (const CLI::ParseError& error) {
    const std::string line = error.what();
    throw Failure(kExitUsage, line.substr(0, line.find('\n')) + "; --help lists the options");
  }
}

CLI::Validator in_range(const Range& range) {
  const auto check = [range](std::string& text) -> std::string {
    const std::string problem = "'" + text + "' is not " + range.text();
    if (!range.is_whole()) {
      const auto value = parse_number(text);
      return value && range.holds(*value) ? "" : problem;
    }
    const auto value = parse_whole(text);
    if (!value || !range.holds(static_cast<double>(*value))) return problem;
    text = std::to_string(*value);
    return "";
  };
  return CLI::Validator(check, "");
}

}  // namespace unisim::tools
