// SPDX-License-Identifier: MIT
// Command lines: help on stdout, mistakes in one line.
#pragma once

namespace CLI {
class App;
}

namespace unisim::tools {

/// Fills the options of `app`. Throws Failure (2) with the option that is wrong.
/// @return false when --help or --version has been answered
bool parse(CLI::App* app, int argc, const char* const* argv);

}  // namespace unisim::tools
