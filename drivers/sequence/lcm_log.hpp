// SPDX-License-Identifier: MIT
// LCM event logs: where the images lie. Read by ourselves: whatever a file holds, nothing is read
// beyond it and no more memory is taken than for its list of images.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace unisim::sequence {

/// One message of type image_t.
struct LoggedImage {
  int64_t timestamp_ns;
  int64_t offset;  ///< of the message in the file
  int64_t size;    ///< bytes
};

struct LcmLog {
  std::string channel;
  std::vector<LoggedImage> images;  ///< as they follow in the file
  std::vector<std::string> notes;   ///< damage, and what is no image
};

/// Whether a file begins like an event log.
bool begins_as_lcm_log(const std::string& path);

/// @param channel "": UNISIM_IMAGE, or the only one that carries images
/// @throws InputError when there is no such channel, or the file cannot be read
LcmLog list_lcm_log(const std::string& path, const std::string& channel);

}  // namespace unisim::sequence
