// SPDX-License-Identifier: MIT
// Command lines: help on stdout, mistakes in one line.
#pragma once

#include "tools/common/range.hpp"

namespace CLI {
class App;
class Validator;
}  // namespace CLI

namespace unisim::tools {

/// Fills the options of `app`. Throws Failure (2) with the option that is wrong.
/// @return false when --help or --version has been answered
bool parse(CLI::App* app, int argc, const char* const* argv);

/// For CLI::Option::transform() of an option with a number: its mistakes name the range. Decimal,
/// "010" is ten.
CLI::Validator in_range(const Range& range);

}  // namespace unisim::tools
