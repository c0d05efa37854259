// SPDX-License-Identifier: MIT
// What went wrong with a device, in one line: what, where, what to do.
#include "drivers/v4l2/failure.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "drivers/v4l2/v4l2.h"

namespace unisim::v4l2 {
namespace {

int problem_of(int error) {
  switch (error) {
    case EACCES:
    case EPERM:
      return UNISIM_V4L2_NOT_ALLOWED;
    case EBUSY:
      return UNISIM_V4L2_BUSY;
    case ENOENT:
    case ENODEV:
    case ENXIO:
    case ENOTTY:
      return UNISIM_V4L2_NO_CAMERA;
    default:
      return UNISIM_V4L2_FAILED;
  }
}

}  // namespace

bool means_unplugged(int error) { return error == ENODEV || error == ENXIO || error == ENOENT; }

const char* advice(int error) {
  switch (error) {
    case EACCES:
    case EPERM:
      return "add yourself to group video (sudo usermod -aG video $USER) and log in again";
    case EBUSY:
      return "another program has it: close that (fuser -v names it)";
    case ENOENT:
    case ENODEV:
    case ENXIO:
      return "no such camera: plug it in, or choose one from the list of cameras";
    case ENOTTY:
      return "this is no camera: choose one from the list of cameras";
    case ENOSPC:
      return "not enough USB bandwidth: ask for a smaller size or for MJPG, or use another port";
    case ENOMEM:
      return "not enough memory: ask for a smaller size or fewer buffers";
    case EMFILE:
    case ENFILE:
      return "too many files are open: close some, or raise ulimit -n";
    case ETIMEDOUT:
    case EIO:
      return "the camera does not answer: unplug it and plug it in again";
    default:
      return "the camera's driver refuses: ask for another size, rate or format";
  }
}

void describe(const char* device, const char* call, int error, char* text, size_t capacity) {
  // strerror() may take memory; these names do not.
  const char* name = strerrordesc_np(error);
  std::snprintf(text, capacity, "%s: %s: %s: %s", device, call,
                name != nullptr ? name : "unknown error", advice(error));
}

DeviceError call_failed(const std::string& device, const char* call, int error) {
  char text[512];
  describe(device.c_str(), call, error, text, sizeof text);
  return DeviceError(problem_of(error), error, text);
}

std::string fourcc_text(uint32_t fourcc) {
  std::string text;
  for (int shift = 0; shift < 32; shift += 8) {
    const auto letter = static_cast<char>((fourcc >> shift) & 0x7f);
    text += letter >= ' ' && letter != 0x7f ? letter : '?';
  }
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

std::string rate_text(double fps) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", fps);
  return text;
}

}  // namespace unisim::v4l2
