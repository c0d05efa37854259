// SPDX-License-Identifier: MIT
// Image sizes in messages.
#pragma once

#include <cstdint>
#include <string>

namespace unisim::drivers {

/// "640x480"
inline std::string size_text(int32_t width, int32_t height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

}  // namespace unisim::drivers
