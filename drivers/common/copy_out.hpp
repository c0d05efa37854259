// SPDX-License-Identifier: MIT
// Output structs of the C headers: how far they are filled.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace unisim::drivers {

/// The caller's struct may be smaller or larger than ours: what both sides know is copied, the rest
/// of a larger one is zero, its struct_size stays.
template <typename Struct>
void copy_out(Struct ours, Struct* theirs) {
  const size_t size = theirs->struct_size;
  ours.struct_size = theirs->struct_size;
  std::memset(static_cast<void*>(theirs), 0, size);
  std::memcpy(static_cast<void*>(theirs), &ours, std::min(size, sizeof ours));
}

}  // namespace unisim::drivers
