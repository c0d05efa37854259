// SPDX-License-Identifier: MIT
// What a configuration file may set: each field with its place and its range.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "tools/common/range.hpp"
#include "tools/replay/settings.hpp"

namespace unisim::replay {

struct Field {
  std::string section;
  std::string key;
  std::variant<int32_t*, uint32_t*, double*, bool*> target;
  tools::Range range;  ///< bool: not asked

  std::string name() const { return section + "." + key; }
};

std::vector<Field> all_fields(Settings* settings);

// Ends of ranges that options of the command line have too.
constexpr int64_t kMostStride = 1000000;
constexpr double kMostFocalPx = 1e6;
// Fisheye polynomials of high order run to hundreds.
constexpr double kMostDistortion = 1e6;
constexpr double kMostReadoutMs = 200.0;
constexpr int64_t kMostThreads = 256;
constexpr int64_t kMostMemoryMb = 100000000;

}  // namespace unisim::replay
