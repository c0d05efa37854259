// SPDX-License-Identifier: MIT
// What the programs say: results on stdout, where they can be lost, and problems on stderr.
#pragma once

#include <string>

namespace unisim::tools {

/// Writes to stdout at once. After a failure nothing more is tried: output_problem() knows.
void print(const std::string& text);

/// Why output was lost; empty while all of it went out, and when the reader has gone away: a pipe
/// that somebody closed has seen what was wanted of it.
std::string output_problem();

/// One line on stderr, "program: line".
void complain(const char* program, const std::string& line);

}  // namespace unisim::tools
