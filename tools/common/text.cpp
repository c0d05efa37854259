// SPDX-License-Identifier: MIT
// Text for people and for formats with a character set.
#include "tools/common/text.hpp"

#include <cstdint>

namespace unisim::tools {
namespace {

constexpr const char* kReplacement = "\xEF\xBF\xBD";

/// A run of bytes that is one character, or one byte that is none.
struct Character {
  size_t length;
  bool valid;
  uint32_t code;
};

// Shortest encoding only, no surrogates, nothing beyond U+10FFFF: what JSON parsers accept.
bool allowed(uint32_t code, size_t length) {
  constexpr uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  return code >= kLeast[length] && code <= 0x10FFFF && !surrogate;
}

Character first_character(std::string_view text) {
  const auto byte = [&](size_t k) { return static_cast<unsigned char>(text[k]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return {1, true, lead};
  const size_t length = lead >= 0xF8   ? 0
                        : lead >= 0xF0 ? 4
                        : lead >= 0xE0 ? 3
                        : lead >= 0xC0 ? 2
                                       : 0;
  if (length == 0 || length > text.size()) return {1, false, 0};
  uint32_t code = lead & (0x7Fu >> length);
  for (size_t k = 1; k < length; ++k) {
    if ((byte(k) & 0xC0) != 0x80) return {1, false, 0};
    code = code << 6 | (byte(k) & 0x3Fu);
  }
  return allowed(code, length) ? Character{length, true, code} : Character{1, false, 0};
}

bool is_control(uint32_t code) { return code < 0x20 || (code >= 0x7F && code < 0xA0); }

}  // namespace

std::string valid_utf8(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const Character next = first_character(text);
    if (next.valid)
      out += text.substr(0, next.length);
    else
      out += kReplacement;
    text.remove_prefix(next.length);
  }
  return out;
}

std::string one_line(std::string_view text) {
  const std::string valid = valid_utf8(text);
  std::string out;
  for (std::string_view rest = valid; !rest.empty();) {
    const Character next = first_character(rest);
    if (is_control(next.code))
      out += '?';
    else
      out += rest.substr(0, next.length);
    rest.remove_prefix(next.length);
  }
  return out;
}

}  // namespace unisim::tools
