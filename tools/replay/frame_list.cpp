// SPDX-License-Identifier: MIT
// The frames of a sequence, for programs that read the same images.
#include "tools/replay/frame_list.hpp"

#include <algorithm>

#include "drivers/common/format.hpp"
#include "drivers/sequence/sequence.h"
#include "tools/common/failure.hpp"
#include "tools/common/json_text.hpp"
#include "tools/common/output.hpp"
#include "tools/common/text.hpp"
#include "tools/replay/inputs.hpp"
#include "tools/replay/version.hpp"

namespace unisim::replay {
namespace {

/// The bytes of a name that JSON cannot hold.
std::string hex(const std::string& bytes) {
  std::string text;
  for (const char c : bytes) text += drivers::format("%02x", static_cast<unsigned char>(c));
  return text;
}

tools::Json frame_line(const unisim_source* source, const unisim_frame& frame) {
  const std::string path = unisim_sequence_frame_path(source);
  tools::Json line = {{"index", frame.index},
                      {"time_ns", frame.timestamp_ns},
                      {"time", static_cast<double>(frame.timestamp_ns) * 1e-9},
                      {"format", source->format},
                      {"file", path}};
  if (tools::valid_utf8(path) != path) line["file_hex"] = hex(path);
  unisim_sequence_pixels pixels{};
  pixels.struct_size = sizeof pixels;
  unisim_sequence_get_pixels(source, &pixels);
  if (pixels.orientation != 1) line["orientation"] = pixels.orientation;
  if (pixels.bits != 16) line["bits"] = pixels.bits;
  if (pixels.width > 0) line["stretched"] = {pixels.width, pixels.height};
  return line;
}

}  // namespace

int list_frames(const Options& options, const std::atomic<bool>& stop) {
  std::vector<std::string> notes;
  const SourcePtr source = open_sequence(options, &notes);
  for (const std::string& note : notes) tools::complain(kProgramName, note);
  const int64_t stride = std::max(options.settings.pipeline.keyframes.stride, 1);
  for (;;) {
    if (stop) throw tools::Failure(tools::kExitOther, "interrupted");
    unisim_frame frame{};
    const int status = source->next_frame(source.get(), 0, &frame);
    if (status == UNISIM_FRAME_END) return tools::kExitDone;
    if (status == UNISIM_FRAME_FAILED) {
      throw tools::Failure(tools::kExitInput, source->message(source.get()));
    }
    if (status == UNISIM_FRAME_BAD) {
      tools::complain(kProgramName, source->message(source.get()));
    } else if ((frame.index - options.from) % stride == 0) {
      tools::print(tools::json_text(frame_line(source.get(), frame)) + "\n");
    }
  }
}

}  // namespace unisim::replay
