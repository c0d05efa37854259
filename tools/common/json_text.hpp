// SPDX-License-Identifier: MIT
// JSON as the programs write it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace unisim::tools {

using Json = nlohmann::ordered_json;

/// JSON that every parser takes, whatever bytes its strings hold: what is not UTF-8 becomes U+FFFD.
/// @param indent blanks per level, -1: one line
inline std::string json_text(const Json& value, int indent = -1) {
  return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace unisim::tools
