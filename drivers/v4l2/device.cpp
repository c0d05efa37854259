// SPDX-License-Identifier: MIT
// One open and streaming camera.
#include "drivers/v4l2/device.hpp"

#include <algorithm>

#include "drivers/v4l2/failure.hpp"

namespace unisim::v4l2 {

Device::Device(Io& io, const std::string& path, const Settings& settings, ControlMemory* memory,
               std::vector<std::string>* notes)
    : io_(io), path_(path), handle_(io, open_again(io, path.c_str())), memory_(memory) {
  if (handle_.fd() < 0) throw call_failed(path_, "open", -handle_.fd());
  const Node node = identify(io_, handle_.fd(), path_);
  if (!node.refusal.empty()) throw DeviceError(node.problem, 0, node.refusal);
  identity_ = node.identity;
  const unisim_v4l2_config& config = settings.config;
  try {
    mode_ = negotiate(io_, handle_.fd(), path_,
                      {settings.fourcc, config.width, config.height, config.fps}, notes);
    apply_controls(io_, handle_.fd(), path_, config, memory_, notes);
    started_ns_ = io_.monotonic_ns();
    buffers_ = std::make_unique<Buffers>(io_, handle_.fd(), path_, config.buffers);
  } catch (...) {
    restore_controls(io_, handle_.fd(), *memory_);
    throw;
  }
  // Within what any camera does: a driver may say anything.
  const double fps = std::clamp(mode_.fps > 0 ? mode_.fps : config.fps, 0.01, 10000.0);
  period_ns_ = static_cast<int64_t>(1e9 / fps);
}

Device::~Device() {
  buffers_.reset();
  restore_controls(io_, handle_.fd(), *memory_);
}

}  // namespace unisim::v4l2
