// SPDX-License-Identifier: MIT
// Reading of line-based text files with numbers, whatever the locale and the line ends.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace unisim::sequence {

/// Input that cannot be used. The text is one line: what, where, what to do.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One line of a file.
struct TextLine {
  std::string text;  ///< without line end and surrounding blanks
  int64_t number;    ///< 1-based, for messages
};

/// Lines that are neither blank nor comments (#). A byte order mark is passed over.
/// @throws InputError when the file cannot be read
std::vector<TextLine> read_lines(const std::string& path);

/// Fields between blanks and, if `commas`, commas. They point into `line`.
std::vector<std::string_view> split_fields(std::string_view line, bool commas = false);

/// Whole text as a number; "nan" and "inf" are numbers. @return false if it is not one
bool parse_number(std::string_view text, double* value);

}  // namespace unisim::sequence
