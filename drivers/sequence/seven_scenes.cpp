// SPDX-License-Identifier: MIT
// 7-Scenes: frame-NNNNNN.color.png or .jpg with frame-NNNNNN.pose.txt, 30 Hz by frame number.
#include <charconv>

#include "drivers/sequence/folder.hpp"
#include "drivers/sequence/frame_numbers.hpp"
#include "drivers/sequence/recording.hpp"
#include "drivers/sequence/text_file.hpp"

namespace unisim::sequence {
namespace {

constexpr double kUsualFps = 30.0;
constexpr std::string_view kPrefix = "frame-";
constexpr std::string_view kColour = ".color.";

// Number of "frame-NNNNNN.color.png"; -1 for any other name.
int64_t colour_number(std::string_view name) {
  if (name.substr(0, kPrefix.size()) != kPrefix || !has_image_ending(name)) return -1;
  int64_t number = -1;
  const char* end = name.data() + name.size();
  const auto result = std::from_chars(name.data() + kPrefix.size(), end, number);
  if (result.ec != std::errc() || number < 0) return -1;
  const std::string_view rest(result.ptr, static_cast<size_t>(end - result.ptr));
  return rest.substr(0, kColour.size()) == kColour ? number : -1;
}

bool has_frames(const std::string& folder) {
  if (!is_folder(folder)) return false;
  for (const std::string& name : list_folder(folder)) {
    if (colour_number(name) >= 0) return true;
  }
  return false;
}

// Folders seq-NN with frames, one level down.
std::vector<std::string> find_sequences(const std::string& folder) {
  std::vector<std::string> found;
  for (const std::string& name : list_folder(folder)) {
    if (name.rfind("seq-", 0) == 0 && has_frames(join(folder, name))) found.push_back(name);
  }
  return found;
}

bool recognise(const std::string& path) {
  return is_folder(path) && (has_frames(path) || !find_sequences(path).empty());
}

std::string choose_folder(const std::string& path) {
  if (has_frames(path)) return path;
  const std::vector<std::string> sequences = find_sequences(path);
  if (sequences.empty()) {
    throw InputError(path + ": no frame-*.color.* here or in seq-*: give the folder that has them");
  }
  if (sequences.size() > 1) {
    throw InputError(path + ": holds " + std::to_string(sequences.size()) + " sequences (" +
                     sequences.front() + " to " + sequences.back() + "): give one of them");
  }
  return join(path, sequences.front());
}

bool read_pose(const std::string& path, FilePose* pose) {
  double rows[16];
  size_t count = 0;
  for (const TextLine& line : read_lines(path)) {
    for (const std::string_view field : split_fields(line.text)) {
      if (count == 16 || !parse_number(field, &rows[count])) return false;
      ++count;
    }
  }
  return count == 16 && pose_from_matrix(rows, pose);
}

void add_pose(const std::string& path, int64_t timestamp_ns, GroundTruth* truth) {
  if (!is_file(path)) return;
  FilePose pose{};
  bool good = false;
  try {
    good = read_pose(path, &pose);
  } catch (const InputError&) {
    good = false;
  }
  if (good) {
    pose.timestamp_ns = timestamp_ns;
    truth->poses.push_back(to_stamped_pose(pose));
  } else {
    ++truth->skipped;
  }
}

Recording list(const OpenRequest& request) {
  const std::string folder = choose_folder(request.path);
  const double fps = request.fps > 0 ? request.fps : kUsualFps;
  Recording recording;
  recording.list_path = folder;
  std::vector<int64_t> numbers;
  for (const std::string& name : list_folder(folder)) {
    const int64_t number = colour_number(name);
    if (number < 0) continue;
    numbers.push_back(number);
    const int64_t timestamp_ns = time_at_rate(number, fps);
    recording.frames.push_back({timestamp_ns, join(folder, name)});
    const std::string pose_name = name.substr(0, name.find(kColour)) + ".pose.txt";
    add_pose(join(folder, pose_name), timestamp_ns, &recording.truth);
  }
  if (!recording.truth.poses.empty()) recording.truth.path = join(folder, "frame-*.pose.txt");
  finish_ground_truth(&recording);
  note_gaps(numbers, &recording);
  return recording;
}

}  // namespace

const Format kSevenScenes = {"7scenes", "frame-*.color.*, also in seq-*", recognise, list};

}  // namespace unisim::sequence
