// SPDX-License-Identifier: MIT
// Replica as rendered for iMAP and NICE-SLAM: results/frame*.jpg, traj.txt with a 4x4 matrix per
// line.
#include "drivers/sequence/folder.hpp"
#include "drivers/sequence/frame_numbers.hpp"
#include "drivers/sequence/recording.hpp"
#include "drivers/sequence/text_file.hpp"

namespace unisim::sequence {
namespace {

constexpr double kUsualFps = 30.0;

std::vector<std::string> list_frames(const std::string& folder) {
  std::vector<std::string> frames;
  for (const std::string& name : list_images(folder)) {
    if (name.rfind("frame", 0) == 0) frames.push_back(name);
  }
  return frames;
}

bool recognise(const std::string& path) { return !list_frames(join(path, "results")).empty(); }

// Line k is the pose of frame k, camera to world.
void add_ground_truth(const std::string& path, const std::vector<TextLine>& lines, double fps,
                      Recording* recording) {
  for (size_t k = 0; k < lines.size(); ++k) {
    const auto fields = split_fields(lines[k].text, true);
    double rows[16];
    bool good = fields.size() == 16;
    for (size_t i = 0; good && i < 16; ++i) good = parse_number(fields[i], &rows[i]);
    FilePose pose{};
    if (good && pose_from_matrix(rows, &pose)) {
      pose.timestamp_ns = time_at_rate(static_cast<int64_t>(k), fps);
      recording->truth.poses.push_back(to_stamped_pose(pose));
    } else {
      ++recording->truth.skipped;
    }
  }
  recording->truth.path = path;
  finish_ground_truth(recording);
}

// Number of each frame and the ground truth: the pose of a frame is told by its number.
std::vector<int64_t> number_frames(const std::vector<std::string>& names, const std::string& path,
                                   double fps, Recording* recording) {
  std::vector<int64_t> numbers = frame_numbers(names);
  const bool numbered = !numbers.empty();
  if (!numbered) numbers = positions(names.size());
  if (!is_file(path)) {
    note_gaps(numbers, recording);
    return numbers;
  }
  const std::vector<TextLine> lines = read_lines(path);
  std::string problem;
  std::vector<int64_t> paired = lines_of_images(names, lines.size(), path, recording, &problem);
  if (paired.empty() && !numbered) {
    add_note(recording, "no ground truth: " + problem);
    return numbers;
  }
  add_ground_truth(path, lines, fps, recording);
  if (!paired.empty()) return paired;
  add_note(recording, problem + "; the poses that are there are used by number");
  return numbers;
}

Recording list(const OpenRequest& request) {
  const std::string folder = join(request.path, "results");
  const double fps = request.fps > 0 ? request.fps : kUsualFps;
  Recording recording;
  const std::vector<std::string> names = list_frames(folder);
  if (names.empty()) {
    throw InputError(request.path + ": no results/frame*.jpg: give the folder of a Replica scene");
  }
  const std::vector<int64_t> numbers =
      number_frames(names, join(request.path, "traj.txt"), fps, &recording);
  for (size_t k = 0; k < names.size(); ++k) {
    recording.frames.push_back({time_at_rate(numbers[k], fps), join(folder, names[k])});
  }
  recording.list_path = folder;
  return recording;
}

}  // namespace

const Format kReplica = {"replica", "results/frame*.jpg", recognise, list};

}  // namespace unisim::sequence
