// SPDX-License-Identifier: MIT
// Which node of /dev is meant, at first and after the camera was away.
#include "drivers/v4l2/find_device.hpp"

#include <algorithm>

#include "drivers/v4l2/failure.hpp"
#include "drivers/v4l2/v4l2.h"

namespace unisim::v4l2 {
namespace {

std::vector<std::string> nodes_of(Io& io, const Identity& identity) {
  std::vector<std::string> paths;
  for (const std::string& path : list_devices(io)) {
    const Node node = look_at(io, path);
    if (node.refusal.empty() && node.identity == identity) paths.push_back(path);
  }
  return paths;
}

bool is_number(const std::string& text) {
  return text.size() <= 3 && text.find_first_not_of("0123456789") == std::string::npos;
}

}  // namespace

std::string find_device(Io& io, const std::string& wish) {
  if (!wish.empty() && wish[0] == '/') return wish;
  if (!wish.empty() && is_number(wish)) return "/dev/video" + wish;
  Node refused;
  for (const std::string& path : list_devices(io)) {
    const Node node = look_at(io, path);
    if (node.refusal.empty() && (wish.empty() || node.identity.bus == wish)) return path;
    if (node.problem != 0 && node.problem != UNISIM_V4L2_NO_CAMERA && refused.problem == 0) {
      refused = node;
    }
  }
  // One that could not be looked at may be the one that is meant.
  if (refused.problem != 0) throw DeviceError(refused.problem, 0, refused.refusal);
  throw DeviceError(UNISIM_V4L2_NO_CAMERA, 0,
                    wish.empty() ? "/dev/video*: no camera is there: plug one in"
                                 : wish +
                                       ": no camera is on this bus: choose a device, number "
                                       "or bus name from the list of cameras");
}

Anchor make_anchor(Io& io, const std::string& path, const Identity& identity) {
  Anchor anchor{path, identity, -1};
  const std::vector<std::string> nodes = nodes_of(io, identity);
  const auto own = std::find(nodes.begin(), nodes.end(), io.resolve(path));
  if (own != nodes.end()) anchor.nth = static_cast<int>(own - nodes.begin());
  return anchor;
}

std::string find_again(Io& io, const Anchor& anchor) {
  if (anchor.nth < 0) {
    const Node node = look_at(io, anchor.path);
    return node.refusal.empty() && node.identity == anchor.identity ? anchor.path : "";
  }
  const std::vector<std::string> nodes = nodes_of(io, anchor.identity);
  const auto nth = static_cast<size_t>(anchor.nth);
  return nth < nodes.size() ? nodes[nth] : "";
}

}  // namespace unisim::v4l2
