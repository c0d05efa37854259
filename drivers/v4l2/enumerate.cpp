// SPDX-License-Identifier: MIT
// Which cameras are there, and what each offers.
#include "drivers/v4l2/enumerate.hpp"

#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "drivers/v4l2/failure.hpp"
#include "drivers/v4l2/pixel_formats.hpp"
#include "drivers/v4l2/v4l2.h"

namespace unisim::v4l2 {
namespace {

// No driver has so many; a broken one would answer for ever.
constexpr uint32_t kMostEntries = 512;

template <size_t kSize>
std::string text_of(const uint8_t (&bytes)[kSize]) {
  const char* text = reinterpret_cast<const char*>(bytes);
  return std::string(text, strnlen(text, kSize));
}

// Next entry of a list of the driver. @return false: past its end
bool next_entry(Io& io, int fd, const std::string& path, unsigned long request, const char* call,
                void* entry) {
  const int answer = ioctl_again(io, fd, request, entry);
  // ENOTTY and ENODATA: a driver without such a list.
  if (answer == -EINVAL || answer == -ENOTTY || answer == -ENODATA) return false;
  if (answer < 0) throw call_failed(path, call, -answer);
  return true;
}

double rate_of(const v4l2_fract& interval) {
  return interval.numerator == 0 ? 0.0 : double(interval.denominator) / interval.numerator;
}

bool is_usable(uint32_t fourcc) {
  const std::vector<uint32_t>& usable = usable_formats();
  return std::find(usable.begin(), usable.end(), fourcc) != usable.end();
}

SizeOffer size_offer(const v4l2_frmsizeenum& entry) {
  if (entry.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
    const auto width = static_cast<int32_t>(entry.discrete.width);
    const auto height = static_cast<int32_t>(entry.discrete.height);
    return {width, height, width, height, 1, 1, 0.0};
  }
  const v4l2_frmsize_stepwise& range = entry.stepwise;
  return {static_cast<int32_t>(range.min_width),
          static_cast<int32_t>(range.min_height),
          static_cast<int32_t>(range.max_width),
          static_cast<int32_t>(range.max_height),
          std::max(1, static_cast<int32_t>(range.step_width)),
          std::max(1, static_cast<int32_t>(range.step_height)),
          0.0};
}

std::vector<SizeOffer> read_sizes(Io& io, int fd, const std::string& path, uint32_t fourcc) {
  std::vector<SizeOffer> sizes;
  for (uint32_t i = 0; i < kMostEntries; ++i) {
    v4l2_frmsizeenum entry{};
    entry.index = i;
    entry.pixel_format = fourcc;
    if (!next_entry(io, fd, path, VIDIOC_ENUM_FRAMESIZES, "VIDIOC_ENUM_FRAMESIZES", &entry)) break;
    SizeOffer offer = size_offer(entry);
    if (offer.width <= 0 || offer.height <= 0) continue;
    offer.fps = highest_rate(io, fd, path, fourcc, offer.width, offer.height);
    sizes.push_back(offer);
    if (entry.type != V4L2_FRMSIZE_TYPE_DISCRETE) break;
  }
  return sizes;
}

std::string why_no_camera(uint32_t capabilities) {
  if ((capabilities & V4L2_CAP_VIDEO_CAPTURE) == 0) {
    const bool planes = (capabilities & V4L2_CAP_VIDEO_CAPTURE_MPLANE) != 0;
    return planes ? "gives images in several planes only, which cannot be read"
                  : "is no camera but another kind of video device";
  }
  return (capabilities & V4L2_CAP_STREAMING) == 0 ? "cannot stream into mapped memory" : "";
}

}  // namespace

std::vector<std::string> list_devices(Io& io) {
  std::vector<int> numbers;
  const int answer = io.list_numbers(&numbers);
  if (answer < 0) throw call_failed("/dev", "opendir", -answer);
  std::sort(numbers.begin(), numbers.end());
  std::vector<std::string> paths;
  paths.reserve(numbers.size());
  for (const int number : numbers) paths.push_back("/dev/video" + std::to_string(number));
  return paths;
}

Node identify(Io& io, int fd, const std::string& path) {
  v4l2_capability answer{};
  const int status = ioctl_again(io, fd, VIDIOC_QUERYCAP, &answer);
  if (status < 0) {
    // What is no video device at all says ENOTTY, or EINVAL where it is an old driver.
    throw call_failed(path, "VIDIOC_QUERYCAP", status == -EINVAL ? ENOTTY : -status);
  }
  const bool own = (answer.capabilities & V4L2_CAP_DEVICE_CAPS) != 0;
  Node node;
  node.path = path;
  node.identity = {text_of(answer.driver), text_of(answer.card), text_of(answer.bus_info)};
  const std::string why = why_no_camera(own ? answer.device_caps : answer.capabilities);
  if (!why.empty()) {
    node.refusal =
        path + " (" + node.identity.card + ") " + why + ": choose another from the list of cameras";
    node.problem = UNISIM_V4L2_NO_CAMERA;
  }
  return node;
}

Node look_at(Io& io, const std::string& path) {
  const Handle handle(io, open_again(io, path.c_str()));
  try {
    if (handle.fd() < 0) throw call_failed(path, "open", -handle.fd());
    return identify(io, handle.fd(), path);
  } catch (const DeviceError& error) {
    Node node;
    node.path = path;
    node.refusal = error.what();
    node.problem = error.problem();
    return node;
  }
}

std::vector<FormatOffer> read_offers(Io& io, int fd, const std::string& path) {
  std::vector<FormatOffer> offers;
  for (uint32_t i = 0; i < kMostEntries; ++i) {
    v4l2_fmtdesc entry{};
    entry.index = i;
    entry.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (!next_entry(io, fd, path, VIDIOC_ENUM_FMT, "VIDIOC_ENUM_FMT", &entry)) break;
    FormatOffer offer{entry.pixelformat, {}};
    if (is_usable(entry.pixelformat)) offer.sizes = read_sizes(io, fd, path, entry.pixelformat);
    offers.push_back(std::move(offer));
  }
  return offers;
}

double highest_rate(Io& io, int fd, const std::string& path, uint32_t fourcc, int32_t width,
                    int32_t height) {
  double highest = 0.0;
  for (uint32_t i = 0; i < kMostEntries; ++i) {
    v4l2_frmivalenum entry{};
    entry.index = i;
    entry.pixel_format = fourcc;
    entry.width = static_cast<uint32_t>(width);
    entry.height = static_cast<uint32_t>(height);
    if (!next_entry(io, fd, path, VIDIOC_ENUM_FRAMEINTERVALS, "VIDIOC_ENUM_FRAMEINTERVALS",
                    &entry)) {
      break;
    }
    const bool one = entry.type == V4L2_FRMIVAL_TYPE_DISCRETE;
    highest = std::max(highest, rate_of(one ? entry.discrete : entry.stepwise.min));
    if (!one) break;
  }
  return highest;
}

}  // namespace unisim::v4l2
