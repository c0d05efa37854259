// SPDX-License-Identifier: MIT
// A view of the run as events of the page.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tools/live/web/top_view.hpp"
#include "tools/live/web/view.hpp"

namespace unisim::live::web {

/// Kinds of events, by what a page needs first.
enum class EventKind { kStatus, kMap, kFrame };
inline constexpr size_t kEventKinds = 3;

/// Makes server-sent events: a name and one line of JSON. README.md lists their fields.
class EventText {
 public:
  explicit EventText(const std::string& source) : source_(source) {}

  /// @param silent_s since the tracking said something last
  std::string status(const View& view, double silent_s) const;
  /// The image, what is followed in it, and where the camera is.
  std::string frame(const View& view);
  /// Trajectories and points, seen from above.
  std::string map(const View& view);

 private:
  std::string source_;
  TopView top_;
  std::vector<uint8_t> jpeg_;
};

}  // namespace unisim::live::web
