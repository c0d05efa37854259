// SPDX-License-Identifier: MIT
// Which cameras are there, and what each offers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/v4l2/io_table.hpp"

namespace unisim::v4l2 {

/// Who a device says it is. Of one camera all are the same wherever it is found again.
struct Identity {
  std::string driver;
  std::string card;
  std::string bus;
  bool operator==(const Identity& other) const {
    return driver == other.driver && card == other.card && bus == other.bus;
  }
};

/// What a node of /dev answers when asked who it is.
struct Node {
  std::string path;
  Identity identity;
  std::string refusal;  ///< "": a camera; else the line that says why it is none
  int problem = 0;      ///< UNISIM_V4L2_* of the refusal
};

/// A size, or with a step a range of sizes.
struct SizeOffer {
  int32_t width;
  int32_t height;
  int32_t max_width;  ///< = width: one size
  int32_t max_height;
  int32_t step_x;
  int32_t step_y;
  double fps;  ///< highest rate, of a range at its smallest size; 0: not said
};

struct FormatOffer {
  uint32_t fourcc;
  std::vector<SizeOffer> sizes;  ///< empty: the driver does not list them
};

/// Paths of all video devices by number, cameras or not. @throws DeviceError
std::vector<std::string> list_devices(Io& io);

/// Asks an open device. @throws DeviceError when the call fails
Node identify(Io& io, int fd, const std::string& path);

/// Opens a device, asks and closes it; failures are in its refusal.
Node look_at(Io& io, const std::string& path);

/// All formats of a camera, those of no use here too; sizes are only read of the others.
/// @throws DeviceError
std::vector<FormatOffer> read_offers(Io& io, int fd, const std::string& path);

/// Highest rate of a size, 0 when not said. @throws DeviceError
double highest_rate(Io& io, int fd, const std::string& path, uint32_t fourcc, int32_t width,
                    int32_t height);

}  // namespace unisim::v4l2
