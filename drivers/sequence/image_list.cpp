// SPDX-License-Identifier: MIT
// A folder of images or a pattern of file names, in natural order at a constant rate.
#include "drivers/sequence/folder.hpp"
#include "drivers/sequence/recording.hpp"
#include "drivers/sequence/text_file.hpp"

namespace unisim::sequence {
namespace {

constexpr double kUsualFps = 30.0;

bool is_pattern(const std::string& path) {
  return !is_folder(path) && !is_file(path) && path.find_first_of("*?[") != std::string::npos;
}

std::vector<std::string> list_paths(const std::string& path) {
  if (is_pattern(path)) return list_pattern(path);
  if (is_file(path)) return {path};
  std::vector<std::string> paths = list_images(path);
  for (std::string& name : paths) name = join(path, name);
  return paths;
}

bool recognise(const std::string& path) { return is_pattern(path) || !list_images(path).empty(); }

Recording list(const OpenRequest& request) {
  const double fps = request.fps > 0 ? request.fps : kUsualFps;
  Recording recording;
  int64_t position = 0;
  for (std::string& path : list_paths(request.path)) {
    recording.frames.push_back({time_at_rate(position++, fps), std::move(path)});
  }
  if (recording.frames.empty()) {
    throw InputError(request.path +
                     ": no image (png, jpg, bmp, pgm, ppm, tif, webp) found: give a folder "
                     "of images or a quoted pattern such as 'dir/*.png'");
  }
  return recording;
}

}  // namespace

const Format kImageList = {"images", "png, jpg, bmp, pgm, ppm, tif or webp files", recognise, list};

}  // namespace unisim::sequence
