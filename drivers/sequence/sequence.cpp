// SPDX-License-Identifier: MIT
// Opening of recorded sequences: recognises the format and hands over to its reader.
#include "drivers/sequence/sequence.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <limits>
#include <opencv2/core/utils/logger.hpp>
#include <string>

#include "drivers/common/copy_out.hpp"
#include "drivers/sequence/folder.hpp"
#include "drivers/sequence/frame_source.hpp"
#include "drivers/sequence/text_file.hpp"

namespace unisim::sequence {
namespace {

// In the order of recognition: the formats with the plainest signs first.
constexpr const Format* kFormats[] = {&kTum,     &kSevenScenes, &kEuroc, &kKitti,
                                      &kReplica, &kLcm,         &kVideo, &kImageList};

const Format& format_by_name(const std::string& name) {
  std::string known;
  for (const Format* format : kFormats) {
    if (name == format->name) return *format;
    known += std::string(known.empty() ? "" : ", ") + format->name;
  }
  throw InputError("format '" + name + "' is not known: give auto, " + known);
}

const Format& recognise_format(const std::string& path) {
  std::string looked_for;
  for (const Format* format : kFormats) {
    if (format->recognise(path)) return *format;
    looked_for +=
        std::string(looked_for.empty() ? "" : "; ") + format->signs + " (" + format->name + ")";
  }
  throw InputError(path + ": no sequence of a known format: give its folder; looked for " +
                   looked_for);
}

void check_path(const std::string& path) {
  if (path.empty()) throw InputError("no path given: give a folder, a pattern or a video file");
  if (is_folder(path)) {
    if (list_folder(path).empty()) throw InputError(path + ": empty folder: give one with images");
  } else if (!is_file(path) && path.find_first_of("*?[") == std::string::npos) {
    throw InputError(path + ": no such folder or file: check the path");
  }
}

// Struct sizes of older callers leave the tail at its defaults.
unisim_sequence_options copy_options(const unisim_sequence_options* given) {
  unisim_sequence_options options{};
  if (given == nullptr) return options;
  if (given->struct_size < sizeof(unisim_sequence_options)) {
    throw InputError("unisim_sequence_options: struct_size is " +
                     std::to_string(given->struct_size) +
                     ": set it to sizeof(unisim_sequence_options)");
  }
  std::memcpy(&options, given, sizeof options);
  if (options.from < 0) throw InputError("first frame is negative: give 0 or more");
  if (options.to > 0 && options.to <= options.from) {
    throw InputError("frame range [" + std::to_string(options.from) + ", " +
                     std::to_string(options.to) + ") is empty: the end must be after the start");
  }
  if (!(options.fps >= 0 && options.fps <= 1e6)) throw InputError("frame rate must be 0 to 1e6");
  return options;
}

std::unique_ptr<FrameSource> open(const std::string& path, const unisim_sequence_options& options) {
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  const std::string name = options.format != nullptr ? options.format : "auto";
  const Format* chosen = name == "auto" ? nullptr : &format_by_name(name);
  check_path(path);
  const Format& format = chosen != nullptr ? *chosen : recognise_format(path);
  const std::string channel = options.channel != nullptr ? options.channel : "";
  if (!channel.empty() && &format != &kLcm) {
    throw InputError(path + ": a channel goes with LCM event logs, this is " + format.name);
  }
  const OpenRequest request = {path, options.fps, channel};
  FrameRange range = {options.from,
                      options.to > 0 ? options.to : std::numeric_limits<int64_t>::max()};
  if (format.open != nullptr) return format.open(request, range);
  Recording recording = format.list(request);
  put_in_time_order(&recording);
  const auto count = static_cast<int64_t>(recording.frames.size());
  check_begin(path, count, range.from);
  range.to = std::min(range.to, count);
  return make_image_source(format.name, std::move(recording), range);
}

}  // namespace
}  // namespace unisim::sequence

unisim_source* unisim_sequence_open(const char* path, const unisim_sequence_options* options,
                                    char* message, size_t message_size) {
  std::string failure;
  try {
    return unisim::sequence::open(path != nullptr ? path : "",
                                  unisim::sequence::copy_options(options))
        .release();
  } catch (const std::exception& error) {
    failure = error.what();
  }
  if (message != nullptr && message_size > 0) {
    std::snprintf(message, message_size, "%s", failure.c_str());
  }
  return nullptr;
}

const char* unisim_sequence_note(const unisim_source* source, int32_t i) {
  const auto& notes = static_cast<const unisim::sequence::FrameSource*>(source)->notes();
  return i >= 0 && static_cast<size_t>(i) < notes.size() ? notes[static_cast<size_t>(i)].c_str()
                                                         : nullptr;
}

const char* unisim_sequence_frame_path(const unisim_source* source) {
  return static_cast<const unisim::sequence::FrameSource*>(source)->frame_path().c_str();
}

void unisim_sequence_get_pixels(const unisim_source* source, unisim_sequence_pixels* pixels) {
  const unisim::sequence::PixelRule& rule =
      static_cast<const unisim::sequence::FrameSource*>(source)->pixel_rule();
  const unisim_sequence_pixels all = {0, rule.orientation, rule.bits, rule.stretched.width,
                                      rule.stretched.height};
  unisim::drivers::copy_out(all, pixels);
}
