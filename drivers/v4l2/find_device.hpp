// SPDX-License-Identifier: MIT
// Which node of /dev is meant, at first and after the camera was away.
#pragma once

#include <string>

#include "drivers/v4l2/enumerate.hpp"

namespace unisim::v4l2 {

/// By what a camera is found again under another number.
struct Anchor {
  std::string path;  ///< it was opened by
  Identity identity;
  int nth = -1;  ///< among the nodes of this identity, by number; -1: not among those listed
};

/// @param wish path, number, bus name or "" for the first camera
/// @return a path @throws DeviceError when there is no such camera
std::string find_device(Io& io, const std::string& wish);

/// @param path of an open camera @throws DeviceError
Anchor make_anchor(Io& io, const std::string& path, const Identity& identity);

/// @return its path of now, "" when it is not there @throws DeviceError
std::string find_again(Io& io, const Anchor& anchor);

}  // namespace unisim::v4l2
