// SPDX-License-Identifier: MIT
// The C functions of this driver over its classes.
#include "drivers/v4l2/v4l2.h"

#include <string>

#include "drivers/common/copy_out.hpp"
#include "drivers/common/creation.hpp"
#include "drivers/v4l2/failure.hpp"
#include "drivers/v4l2/open.hpp"
#include "drivers/v4l2/settings.hpp"
#include "drivers/v4l2/source.hpp"

namespace {

using unisim::v4l2::CameraSource;

const CameraSource* self(const unisim_source* source) {
  return static_cast<const CameraSource*>(source);
}

}  // namespace

unisim_source* unisim::v4l2::open_camera(Io& io, const unisim_v4l2_config* config, int32_t* problem,
                                         char* message, size_t message_size) {
  return drivers::create<DeviceError>(
      "camera: ", UNISIM_V4L2_FAILED, problem, message, message_size,
      [&]() -> unisim_source* { return new CameraSource(io, check_settings(config)); });
}

unisim_source* unisim_v4l2_open(const unisim_v4l2_config* config, int32_t* problem, char* message,
                                size_t message_size) {
  return unisim::v4l2::open_camera(unisim::v4l2::system_io(), config, problem, message,
                                   message_size);
}

void unisim_v4l2_get_mode(const unisim_source* source, unisim_v4l2_mode* mode) {
  unisim::drivers::copy_out(self(source)->mode(), mode);
}

const char* unisim_v4l2_note(const unisim_source* source, int32_t index) {
  const auto& notes = self(source)->notes();
  return index >= 0 && static_cast<size_t>(index) < notes.size()
             ? notes[static_cast<size_t>(index)].c_str()
             : nullptr;
}

void unisim_v4l2_get_statistics(const unisim_source* source, unisim_v4l2_statistics* statistics) {
  const unisim::v4l2::Counters& counters = self(source)->counters();
  const unisim_v4l2_statistics all = {0,
                                      0,
                                      counters.frames,
                                      counters.lost,
                                      counters.superseded,
                                      counters.errors,
                                      counters.bad,
                                      counters.restamped,
                                      counters.restarts,
                                      counters.reconnects};
  unisim::drivers::copy_out(all, statistics);
}
