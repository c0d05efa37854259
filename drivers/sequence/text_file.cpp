// SPDX-License-Identifier: MIT
// Reading of line-based text files with numbers, whatever the locale and the line ends.
#include "drivers/sequence/text_file.hpp"

#include <sys/stat.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>

namespace unisim::sequence {
namespace {

constexpr std::string_view kBlanks = " \t\r\n\v\f";

std::string_view trim(std::string_view text) {
  const size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

}  // namespace

std::vector<TextLine> read_lines(const std::string& path) {
  struct stat info{};
  if (stat(path.c_str(), &info) == 0 && S_ISDIR(info.st_mode)) {
    throw InputError(path + ": a folder where a text file is expected");
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw InputError(path + ": cannot read: " + std::strerror(errno != 0 ? errno : EIO));
  }
  std::vector<TextLine> lines;
  std::string raw;
  for (int64_t number = 1; std::getline(file, raw); ++number) {
    std::string_view text = raw;
    if (number == 1 && (text.substr(0, 2) == "\xFF\xFE" || text.substr(0, 2) == "\xFE\xFF")) {
      throw InputError(path + ": text in UTF-16: save it as UTF-8");
    }
    if (number == 1 && text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
    text = trim(text);
    if (!text.empty() && text.front() != '#') lines.push_back({std::string(text), number});
  }
  return lines;
}

std::vector<std::string_view> split_fields(std::string_view line, bool commas) {
  const std::string separators = std::string(kBlanks) + (commas ? "," : "");
  std::vector<std::string_view> fields;
  size_t at = line.find_first_not_of(separators);
  while (at != std::string_view::npos) {
    const size_t end = std::min(line.find_first_of(separators, at), line.size());
    fields.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(separators, end);
  }
  return fields;
}

bool parse_number(std::string_view text, double* value) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  if (text.empty()) return false;
  const char* end = text.data() + text.size();
  const std::from_chars_result result = std::from_chars(text.data(), end, *value);
  return result.ec == std::errc() && result.ptr == end;
}

}  // namespace unisim::sequence
