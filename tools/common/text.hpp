// SPDX-License-Identifier: MIT
// Text for people and for formats with a character set.
#pragma once

#include <string>
#include <string_view>

namespace unisim::tools {

/// The same text where it is UTF-8; each byte that is not becomes U+FFFD. File names are bytes of
/// any kind, JSON and HTML are not.
std::string valid_utf8(std::string_view text);

/// Text from outside as one line for a terminal: valid UTF-8, control characters become "?".
std::string one_line(std::string_view text);

}  // namespace unisim::tools
