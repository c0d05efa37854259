// SPDX-License-Identifier: MIT
// Exposure, focus and mains frequency of a camera, put back at the end.
#include "drivers/v4l2/controls.hpp"

#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>

#include "drivers/v4l2/failure.hpp"

namespace unisim::v4l2 {
namespace {

class Setter {
 public:
  Setter(Io& io, int fd, const std::string& device, ControlMemory* memory,
         std::vector<std::string>* notes)
      : io_(io), fd_(fd), device_(device), memory_(memory), notes_(notes) {}

  bool offers(uint32_t id) {
    v4l2_queryctrl range{};
    return query(id, &range);
  }

  bool offers_choice(uint32_t id, int32_t choice) {
    v4l2_querymenu entry{};
    entry.id = id;
    entry.index = static_cast<uint32_t>(choice);
    return call(VIDIOC_QUERYMENU, "VIDIOC_QUERYMENU", &entry) == 0;
  }

  /// Sets a control to a value, or the nearest one it can have.
  void set(uint32_t id, const char* name, int32_t wish) {
    v4l2_queryctrl range{};
    if (!query(id, &range)) {
      note(std::string("does not offer ") + name);
      return;
    }
    const int32_t value = std::clamp(wish, range.minimum, std::max(range.minimum, range.maximum));
    if (value != wish) {
      note(std::string(name) + " goes from " + std::to_string(range.minimum) + " to " +
           std::to_string(range.maximum) + ": set to " + std::to_string(value) + " instead of " +
           std::to_string(wish));
    }
    v4l2_control control{id, 0};
    const bool known = call(VIDIOC_G_CTRL, "VIDIOC_G_CTRL", &control) == 0;
    if (known && control.value == value) return;
    if (known) memory_->remember(id, control.value);
    control = {id, value};
    const int status = call(VIDIOC_S_CTRL, "VIDIOC_S_CTRL", &control);
    if (status < 0) {
      char text[256];
      describe(name, "VIDIOC_S_CTRL", -status, text, sizeof text);
      note(text);
    }
  }

  /// An automatic is going to move this control.
  void remember(uint32_t id) {
    v4l2_control control{id, 0};
    if (call(VIDIOC_G_CTRL, "VIDIOC_G_CTRL", &control) == 0) memory_->remember(id, control.value);
  }

  /// Sets a control to the value it has: some cameras show what an automatic chose but go back to
  /// their own when it ends.
  void hold(uint32_t id) {
    v4l2_control control{id, 0};
    if (call(VIDIOC_G_CTRL, "VIDIOC_G_CTRL", &control) < 0) return;
    memory_->remember(id, control.value);
    call(VIDIOC_S_CTRL, "VIDIOC_S_CTRL", &control);
  }

  void note(const std::string& text) { notes_->push_back(device_ + ": " + text); }

 private:
  int call(unsigned long request, const char* name, void* argument) {
    const int status = ioctl_again(io_, fd_, request, argument);
    if (status < 0 && means_unplugged(-status)) throw call_failed(device_, name, -status);
    return status;
  }

  bool query(uint32_t id, v4l2_queryctrl* range) {
    range->id = id;
    return call(VIDIOC_QUERYCTRL, "VIDIOC_QUERYCTRL", range) == 0 &&
           (range->flags & V4L2_CTRL_FLAG_DISABLED) == 0;
  }

  Io& io_;
  int fd_;
  const std::string& device_;
  ControlMemory* memory_;
  std::vector<std::string>* notes_;
};

// Most webcams have only one of the two automatic and one of the two manual modes.
int32_t exposure_mode(Setter* setter, bool automatic) {
  const int32_t first = automatic ? V4L2_EXPOSURE_APERTURE_PRIORITY : V4L2_EXPOSURE_MANUAL;
  const int32_t second = automatic ? V4L2_EXPOSURE_AUTO : V4L2_EXPOSURE_SHUTTER_PRIORITY;
  const bool other = !setter->offers_choice(V4L2_CID_EXPOSURE_AUTO, first) &&
                     setter->offers_choice(V4L2_CID_EXPOSURE_AUTO, second);
  return other ? second : first;
}

void apply_exposure(Setter* setter, const unisim_v4l2_config& config) {
  const bool automatic = config.exposure == UNISIM_V4L2_AUTO;
  if (automatic) setter->remember(V4L2_CID_EXPOSURE_ABSOLUTE);
  if (config.exposure != UNISIM_V4L2_KEEP) {
    setter->set(V4L2_CID_EXPOSURE_AUTO, "automatic exposure", exposure_mode(setter, automatic));
  }
  if (config.exposure == UNISIM_V4L2_FIXED) {
    if (config.exposure_us > 0) {
      // The kernel counts in steps of 100 us.
      setter->set(V4L2_CID_EXPOSURE_ABSOLUTE, "exposure time in 100 us",
                  std::max(1, (config.exposure_us + 50) / 100));
    } else {
      setter->hold(V4L2_CID_EXPOSURE_ABSOLUTE);
    }
  }
  if (config.constant_rate != 0 && setter->offers(V4L2_CID_EXPOSURE_AUTO_PRIORITY)) {
    setter->set(V4L2_CID_EXPOSURE_AUTO_PRIORITY, "constant frame rate", 0);
  }
}

void apply_focus(Setter* setter, const unisim_v4l2_config& config) {
  if (config.focus == UNISIM_V4L2_KEEP) return;
  if (config.focus == UNISIM_V4L2_AUTO) setter->remember(V4L2_CID_FOCUS_ABSOLUTE);
  setter->set(V4L2_CID_FOCUS_AUTO, "automatic focus", config.focus == UNISIM_V4L2_AUTO ? 1 : 0);
  if (config.focus != UNISIM_V4L2_FIXED) return;
  if (config.focus_position >= 0) {
    setter->set(V4L2_CID_FOCUS_ABSOLUTE, "focus position", config.focus_position);
  } else {
    setter->hold(V4L2_CID_FOCUS_ABSOLUTE);
  }
}

int32_t power_line_choice(int32_t hz) {
  if (hz == 50) return V4L2_CID_POWER_LINE_FREQUENCY_50HZ;
  return hz == 60 ? V4L2_CID_POWER_LINE_FREQUENCY_60HZ : V4L2_CID_POWER_LINE_FREQUENCY_DISABLED;
}

}  // namespace

void ControlMemory::remember(uint32_t id, int32_t value) {
  for (const Value& one : values_) {
    if (one.id == id) return;
  }
  values_.push_back({id, value});
}

void apply_controls(Io& io, int fd, const std::string& device, const unisim_v4l2_config& config,
                    ControlMemory* memory, std::vector<std::string>* notes) {
  Setter setter(io, fd, device, memory, notes);
  apply_exposure(&setter, config);
  apply_focus(&setter, config);
  if (config.power_line_hz != 0) {
    setter.set(V4L2_CID_POWER_LINE_FREQUENCY, "power line frequency",
               power_line_choice(config.power_line_hz));
  }
}

void restore_controls(Io& io, int fd, const ControlMemory& memory) {
  for (auto one = memory.values().rbegin(); one != memory.values().rend(); ++one) {
    v4l2_control control{one->id, one->value};
    ioctl_again(io, fd, VIDIOC_S_CTRL, &control);
  }
}

}  // namespace unisim::v4l2
