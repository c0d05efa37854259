// SPDX-License-Identifier: MIT
// Where an image file says how its picture is turned: EXIF tag 0x0112, the TIFF field of that name.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace unisim::sequence {

struct OrientationTag {
  int value;        ///< 1 to 8, as EXIF counts
  size_t at;        ///< the 16 bits of the value in the file
  bool big_endian;  ///< order of its bytes
};

/// Looks into JPEG, PNG, WebP and TIFF. @return nothing where there is no tag or no sense in it
std::optional<OrientationTag> find_orientation(const std::vector<uint8_t>& file);

}  // namespace unisim::sequence
