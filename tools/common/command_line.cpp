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

}  // namespace unisim::tools
