// SPDX-License-Identifier: MIT
// Exposure, focus and mains frequency of a camera, put back at the end.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/v4l2/io_table.hpp"
#include "drivers/v4l2/v4l2.h"

namespace unisim::v4l2 {

/// Values as they were before this program changed them, in the order of the changes. Kept while
/// a camera is away, which comes back with values of its own.
class ControlMemory {
 public:
  struct Value {
    uint32_t id;
    int32_t value;
  };

  /// Only what is remembered first counts.
  void remember(uint32_t id, int32_t value);
  const std::vector<Value>& values() const { return values_; }

 private:
  std::vector<Value> values_;
};

/// Sets what the configuration asks for.
/// @param[in,out] memory values found
/// @param[in,out] notes  a line for everything the camera does not offer or refuses
/// @throws DeviceError only when the camera is gone
void apply_controls(Io& io, int fd, const std::string& device, const unisim_v4l2_config& config,
                    ControlMemory* memory, std::vector<std::string>* notes);

/// Puts all back, the last change first; failures are passed over.
void restore_controls(Io& io, int fd, const ControlMemory& memory);

}  // namespace unisim::v4l2
