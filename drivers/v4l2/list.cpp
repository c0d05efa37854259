// SPDX-License-Identifier: MIT
// The cameras of the machine as a table for people.
#include "drivers/v4l2/list.hpp"

#include <algorithm>
#include <cstring>

#include "drivers/common/size_text.hpp"
#include "drivers/v4l2/enumerate.hpp"
#include "drivers/v4l2/failure.hpp"
#include "drivers/v4l2/pixel_formats.hpp"
#include "drivers/v4l2/v4l2.h"

namespace unisim::v4l2 {
namespace {

std::string size_line(const SizeOffer& size) {
  std::string text = drivers::size_text(size.width, size.height);
  if (size.max_width != size.width || size.max_height != size.height) {
    text += " to " + drivers::size_text(size.max_width, size.max_height);
  }
  return size.fps > 0 ? text + " @ " + rate_text(size.fps) : text;
}

std::string format_lines(const std::vector<FormatOffer>& offers) {
  std::string text;
  for (const uint32_t fourcc : usable_formats()) {
    const auto offer = std::find_if(offers.begin(), offers.end(),
                                    [&](const FormatOffer& one) { return one.fourcc == fourcc; });
    if (offer == offers.end()) continue;
    text += "    " + fourcc_text(fourcc) + "  ";
    for (const SizeOffer& size : offer->sizes) {
      text += (&size == offer->sizes.data() ? "" : ", ") + size_line(size);
    }
    text += offer->sizes.empty() ? "sizes not listed\n" : "\n";
  }
  return text.empty() ? "    no format of use here (" + usable_formats_text() + ")\n" : text;
}

std::string camera_lines(Io& io, const Node& node) {
  const std::string head = node.path + "  " + node.identity.card + "  " + node.identity.bus + "\n";
  const Handle handle(io, open_again(io, node.path.c_str()));
  try {
    if (handle.fd() < 0) throw call_failed(node.path, "open", -handle.fd());
    return head + format_lines(read_offers(io, handle.fd(), node.path));
  } catch (const DeviceError& error) {
    return head + "    " + error.what() + "\n";
  }
}

}  // namespace

std::string camera_table(Io& io, int32_t* cameras) {
  std::string table;
  *cameras = 0;
  try {
    for (const std::string& path : list_devices(io)) {
      const Node node = look_at(io, path);
      if (node.refusal.empty()) {
        ++*cameras;
        table += camera_lines(io, node);
      } else if (node.problem != UNISIM_V4L2_NO_CAMERA) {
        table += node.refusal + "\n";
      }
    }
  } catch (const DeviceError& error) {
    table += std::string(error.what()) + "\n";
  }
  return table;
}

}  // namespace unisim::v4l2

int32_t unisim_v4l2_list(char* table, size_t capacity, size_t* needed) {
  int32_t cameras = 0;
  const std::string text = unisim::v4l2::camera_table(unisim::v4l2::system_io(), &cameras);
  if (needed != nullptr) *needed = text.size() + 1;
  if (table == nullptr || capacity == 0) return cameras;
  size_t length = text.size();
  if (length >= capacity) {
    const size_t end = capacity > 1 ? text.rfind('\n', capacity - 2) : std::string::npos;
    length = end == std::string::npos ? 0 : end + 1;
  }
  std::memcpy(table, text.data(), length);
  table[length] = '\0';
  return cameras;
}
