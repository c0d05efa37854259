// SPDX-License-Identifier: MIT
// Agreement with a camera on format, size and rate.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/v4l2/io_table.hpp"

namespace unisim::v4l2 {

struct Wish {
  uint32_t fourcc;  ///< 0: any
  int32_t width;
  int32_t height;
  double fps;
};

struct Mode {
  uint32_t fourcc;
  int32_t width;
  int32_t height;
  int32_t stride;       ///< bytes from row to row; 0 for MJPG
  size_t needed_bytes;  ///< of a whole image; 0 for MJPG
  double fps;           ///< 0: the driver does not say
};

/// Sets what comes nearest to the wish and reads back what it became.
/// @param[in,out] notes a line for everything that is not as wished
/// @throws DeviceError
Mode negotiate(Io& io, int fd, const std::string& device, const Wish& wish,
               std::vector<std::string>* notes);

}  // namespace unisim::v4l2
