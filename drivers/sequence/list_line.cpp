// SPDX-License-Identifier: MIT
// One line of a list of images, taken apart.
#include "drivers/sequence/list_line.hpp"

#include <algorithm>
#include <cstdint>

#include "drivers/sequence/folder.hpp"
#include "drivers/sequence/time_text.hpp"

namespace unisim::sequence {
namespace {

constexpr std::string_view kSeparators = " \t\r\v\f,;";

struct Token {
  std::string_view text;  // points into the line
  bool quoted;
};

std::vector<Token> split_tokens(std::string_view line) {
  std::vector<Token> tokens;
  size_t at = line.find_first_not_of(kSeparators);
  while (at != std::string_view::npos) {
    const char mark = line[at];
    const size_t closing =
        mark == '"' || mark == '\'' ? line.find(mark, at + 1) : std::string_view::npos;
    const bool quoted = closing != std::string_view::npos;
    const size_t begin = quoted ? at + 1 : at;
    const size_t end =
        quoted ? closing : std::min(line.find_first_of(kSeparators, at), line.size());
    tokens.push_back({line.substr(begin, end - begin), quoted});
    at = line.find_first_not_of(kSeparators, quoted ? end + 1 : end);
  }
  return tokens;
}

bool is_time(const Token& token) {
  int64_t ignored = 0;
  return parse_time(token.text, TimeUnit::kNanoseconds, &ignored);
}

// Last token of the name that begins at `first`: blanks do not end a name, its ending does.
size_t name_end(const std::vector<Token>& tokens, size_t first) {
  if (tokens[first].quoted) return first;
  for (size_t k = first; k < tokens.size() && !tokens[k].quoted; ++k) {
    if (has_image_ending(tokens[k].text)) return k;
  }
  return tokens.size();
}

std::string span(const Token& first, const Token& last) {
  const char* begin = first.text.data();
  return {begin, static_cast<size_t>(last.text.data() + last.text.size() - begin)};
}

}  // namespace

std::vector<ListedName> parse_list_line(std::string_view line) {
  const std::vector<Token> tokens = split_tokens(line);
  std::vector<ListedName> names;
  size_t at = 0;
  while (at + 1 < tokens.size() && is_time(tokens[at])) {
    size_t last = name_end(tokens, at + 1);
    if (last == tokens.size()) {
      if (!names.empty()) break;  // a further column
      last = at + 1;              // a name without ending
    }
    names.push_back({std::string(tokens[at].text), span(tokens[at + 1], tokens[last])});
    at = last + 1;
  }
  return names;
}

}  // namespace unisim::sequence
