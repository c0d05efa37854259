// SPDX-License-Identifier: MIT
// One line of a list of images, taken apart.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace unisim::sequence {

/// A time and the name after it, as written.
struct ListedName {
  std::string time;
  std::string name;
};

/// The pairs "time name" that a line begins with; none if it begins otherwise.
std::vector<ListedName> parse_list_line(std::string_view line);

}  // namespace unisim::sequence
