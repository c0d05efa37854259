// SPDX-License-Identifier: MIT
// A folder of images or a pattern of file names: times from the names, or their numbers at a rate.
#include <algorithm>

#include "drivers/sequence/folder.hpp"
#include "drivers/sequence/frame_list.hpp"
#include "drivers/sequence/frame_numbers.hpp"
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

constexpr size_t kFewestDecimals = 3;

enum class NameTimes { kNone, kSeconds, kDated };

// Names that are times: of a clock that tells the date, or in seconds with the same number of
// decimals each, which "1.9" and "1.10" have not.
NameTimes times_of(const std::vector<TimedName>& images) {
  std::vector<double> times;
  bool decimals = true;
  const size_t after_point = images.front().time.size() - 1 - images.front().time.find('.');
  for (const TimedName& image : images) {
    double time = 0;
    if (!parse_number(image.time, &time)) return NameTimes::kNone;
    const size_t point = image.time.find('.');
    decimals = decimals && point != std::string::npos && after_point >= kFewestDecimals &&
               image.time.size() - 1 - point == after_point;
    times.push_back(time);
  }
  const TimeUnit unit = guess_unit(times, TimeUnit::kSeconds, kLongestImageStepS);
  const auto is_dated = [unit](double time) { return is_date(time / units_per_second(unit)); };
  if (std::all_of(times.begin(), times.end(), is_dated)) return NameTimes::kDated;
  return decimals ? NameTimes::kSeconds : NameTimes::kNone;
}

// The first image has time 0: the numbers of a recording begin anywhere.
void time_by_number(const std::vector<std::string>& paths, double fps, Recording* recording) {
  std::vector<int64_t> numbers = frame_numbers(paths);
  if (numbers.empty()) {
    numbers = positions(paths.size());
    add_note(recording, recording->list_path +
                            ": names do not differ in one number alone: images have the times of "
                            "their places, gaps between them are not seen");
  }
  note_gaps(numbers, recording);
  const int64_t first = numbers.front();
  for (size_t k = 0; k < paths.size(); ++k) {
    recording->frames.push_back({time_at_rate(numbers[k] - first, fps), paths[k]});
  }
}

void begin_at_zero(Recording* recording) {
  if (recording->frames.empty()) return;
  const int64_t first_ns = recording->frames.front().timestamp_ns;
  for (auto& frame : recording->frames) frame.timestamp_ns -= first_ns;
}

Recording list(const OpenRequest& request) {
  Recording recording;
  recording.list_path = request.path;
  const std::vector<std::string> paths = list_paths(request.path);
  if (paths.empty()) {
    throw InputError(request.path +
                     ": no image (png, jpg, bmp, pgm, ppm, tif, webp) found: give a folder "
                     "of images or a quoted pattern such as 'dir/*.png'");
  }
  std::vector<TimedName> images;
  for (const std::string& path : paths) {
    const std::string name = base_name(path);
    images.push_back({name.substr(0, name.find_last_of('.')), path});
  }
  const NameTimes times = times_of(images);
  if (times != NameTimes::kNone) {
    add_note(&recording, request.path + ": names are read as times");
    add_timed_images(images, TimeUnit::kSeconds, &recording);
    // Seconds of no date begin anywhere, as numbers do: the first image has time 0.
    if (times == NameTimes::kSeconds) begin_at_zero(&recording);
  } else {
    time_by_number(paths, request.fps > 0 ? request.fps : kUsualFps, &recording);
  }
  return recording;
}

}  // namespace

const Format kImageList = {"images", "png, jpg, bmp, pgm, ppm, tif or webp files", recognise, list};

}  // namespace unisim::sequence
