// SPDX-License-Identifier: MIT
// The version of the linked library as text.
#pragma once

#include <string>

#include "unisim/unisim.h"

namespace unisim::replay {

inline std::string version_text() {
  const int32_t version = unisim_version();
  return std::to_string(version / 10000) + "." + std::to_string(version / 100 % 100) + "." +
         std::to_string(version % 100);
}

}  // namespace unisim::replay
