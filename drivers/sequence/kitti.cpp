// SPDX-License-Identifier: MIT
// KITTI odometry: sequences/NN/image_0 with times.txt, poses/NN.txt.
#include "drivers/sequence/folder.hpp"
#include "drivers/sequence/frame_numbers.hpp"
#include "drivers/sequence/recording.hpp"
#include "drivers/sequence/text_file.hpp"
#include "drivers/sequence/time_text.hpp"

namespace unisim::sequence {
namespace {

constexpr double kUsualFps = 10.0;
constexpr const char* kCameras[] = {"image_0", "image_2", "image_1", "image_3"};

// Image folder of a sequence, "" if there is none: left gray before left colour before right.
std::string find_images(const std::string& sequence) {
  for (const char* camera : kCameras) {
    const std::string folder = join(sequence, camera);
    if (!list_images(folder).empty()) return folder;
  }
  return {};
}

std::vector<std::string> find_sequences(const std::string& root) {
  std::vector<std::string> found;
  const std::string folder = join(root, "sequences");
  if (!is_folder(folder)) return found;
  for (const std::string& name : list_folder(folder)) {
    if (!find_images(join(folder, name)).empty()) found.push_back(name);
  }
  return found;
}

bool recognise(const std::string& path) {
  return is_folder(path) && (!find_images(path).empty() || !find_sequences(path).empty());
}

std::string choose_sequence(const std::string& path) {
  if (!find_images(path).empty()) return path;
  const std::vector<std::string> sequences = find_sequences(path);
  if (sequences.empty()) {
    throw InputError(path +
                     ": no image_0 or sequences/NN/image_0 with images: give the KITTI folder");
  }
  const std::string folder = join(path, "sequences");
  if (sequences.size() > 1) {
    throw InputError(path + ": holds " + std::to_string(sequences.size()) +
                     " sequences: give one, such as " + join(folder, sequences.front()));
  }
  return join(folder, sequences.front());
}

// Pose files of a sequence: NN.txt of the benchmark first, then any other that begins with NN.
std::vector<std::string> find_pose_files(const std::string& sequence) {
  std::vector<std::string> found;
  const std::string folder = join(parent(parent(sequence)), "poses");
  const std::string number = base_name(sequence);
  if (!is_folder(folder)) return found;
  for (const std::string& name : list_folder(folder)) {
    if (name == number + ".txt") {
      found.insert(found.begin(), join(folder, name));
    } else if (name.rfind(number, 0) == 0 && name.size() > 4 &&
               name.substr(name.size() - 4) == ".txt") {
      found.push_back(join(folder, name));
    }
  }
  return found;
}

// Times of the lines of a sequence: from a file, else at a rate.
struct Clock {
  std::string path;             // "" without a file
  std::vector<int64_t> listed;  // by line
  double fps;

  bool has(int64_t line) const {
    return line >= 0 && (path.empty() || line < static_cast<int64_t>(listed.size()));
  }
  int64_t at(int64_t line) const {
    return path.empty() ? time_at_rate(line, fps) : listed[static_cast<size_t>(line)];
  }
};

struct PoseLines {
  std::string path;
  PoseFile file;
  size_t lines() const { return file.poses.size() + static_cast<size_t>(file.skipped); }
};

std::vector<int64_t> read_times(const std::string& path, Recording* recording) {
  const std::vector<TextLine> lines = read_lines(path);
  std::vector<double> numbers(lines.size());
  for (size_t k = 0; k < lines.size(); ++k) {
    if (!parse_number(split_fields(lines[k].text).front(), &numbers[k])) {
      throw InputError(path + ":" + std::to_string(lines[k].number) + ": not a time in seconds");
    }
  }
  const TimeUnit unit = guess_unit(numbers, TimeUnit::kSeconds, kLongestImageStepS);
  if (unit != TimeUnit::kSeconds) note_unit(path, unit, recording);
  std::vector<int64_t> times;
  for (const TextLine& line : lines) {
    int64_t ns = 0;
    if (!parse_time(split_fields(line.text).front(), unit, &ns)) {
      throw InputError(path + ":" + std::to_string(line.number) + ": time out of range");
    }
    times.push_back(ns);
  }
  return times;
}

// times.txt; else the times of a ground truth with a line per frame; else the usual rate.
Clock choose_clock(const std::string& sequence, const std::vector<std::string>& names, double fps,
                   const std::vector<PoseLines>& poses, Recording* recording) {
  Clock clock = {{}, {}, fps > 0 ? fps : kUsualFps};
  const std::string times_path = join(sequence, "times.txt");
  if (is_file(times_path)) {
    clock.listed = read_times(times_path, recording);
    clock.path = times_path;
    return clock;
  }
  if (fps > 0) return clock;
  const std::vector<int64_t> numbers = frame_numbers(names);
  const size_t frames = numbers.empty() ? 0 : static_cast<size_t>(numbers.back()) + 1;
  std::string unused;
  for (const PoseLines& truth : poses) {
    const size_t count = truth.file.poses.size();
    if (truth.file.format != PoseFormat::kTum) continue;
    unused = truth.path;
    if (count != names.size() && count != frames) continue;
    for (const FilePose& pose : truth.file.poses) clock.listed.push_back(pose.timestamp_ns);
    clock.path = truth.path;
    return clock;
  }
  if (!unused.empty()) {
    add_note(recording, times_path + ": missing, and " + unused +
                            " has not a line for each image: images are taken as 10 a second");
  }
  return clock;
}

std::vector<PoseLines> read_poses(const std::string& sequence, Recording* recording) {
  std::vector<PoseLines> poses;
  for (const std::string& path : find_pose_files(sequence)) {
    try {
      poses.push_back({path, read_pose_file(path)});
    } catch (const InputError& error) {
      add_note(recording, std::string("no ground truth: ") + error.what());
    }
  }
  return poses;
}

// Line that belongs to each image. Without times.txt and numbers in the names it is their place.
std::vector<int64_t> choose_lines(const std::vector<std::string>& names, const Clock& clock,
                                  Recording* recording) {
  if (!clock.path.empty()) {
    std::string problem;
    const auto lines = lines_of_images(names, clock.listed.size(), clock.path, recording, &problem);
    if (lines.empty()) throw InputError(problem);
    return lines;
  }
  const std::vector<int64_t> numbers = frame_numbers(names);
  note_gaps(numbers, recording);
  return numbers.empty() ? positions(names.size()) : numbers;
}

// The first file with poses: a matrix per line belongs to the frame of the same number, or to the
// image of the same place where the file has a line for each image but not for each time.
void add_ground_truth(const std::vector<PoseLines>& poses, const Clock& clock,
                      const std::vector<int64_t>& lines, Recording* recording) {
  for (const PoseLines& truth : poses) {
    if (!recording->truth.poses.empty()) break;
    const bool counted = truth.file.format == PoseFormat::kKitti;
    const bool by_place = counted && !truth.file.numbered && truth.lines() == lines.size() &&
                          lines.back() != static_cast<int64_t>(lines.size()) - 1;
    int64_t outside = 0;
    for (const FilePose& pose : truth.file.poses) {
      unisim_stamped_pose stamped = to_stamped_pose(pose);
      if (counted) {
        const int64_t number = pose.timestamp_ns / 1000000000;
        const int64_t line = by_place ? lines[static_cast<size_t>(number)] : number;
        if (!clock.has(line)) {
          ++outside;
          continue;
        }
        stamped.timestamp_ns = clock.at(line);
      }
      recording->truth.poses.push_back(stamped);
    }
    if (by_place) add_note(recording, truth.path + ": a line for each image: paired in order");
    if (outside > 0) {
      add_note(recording, truth.path + ": " + std::to_string(outside) +
                              " poses left out: " + clock.path + " has no such line");
    }
    if (truth.file.foreign_unit) note_unit(truth.path, truth.file.unit, recording);
    recording->truth.path = truth.path;
    recording->truth.skipped = truth.file.skipped;
  }
  finish_ground_truth(recording);
}

Recording list(const OpenRequest& request) {
  const std::string sequence = choose_sequence(request.path);
  const std::string images = find_images(sequence);
  const std::vector<std::string> names = list_images(images);
  Recording recording;
  recording.list_path = images;
  const std::vector<PoseLines> poses = read_poses(sequence, &recording);
  const Clock clock = choose_clock(sequence, names, request.fps, poses, &recording);
  if (!clock.path.empty()) recording.list_path = clock.path;
  const std::vector<int64_t> lines = choose_lines(names, clock, &recording);
  for (size_t k = 0; k < names.size(); ++k) {
    recording.frames.push_back({clock.at(lines[k]), join(images, names[k])});
  }
  add_ground_truth(poses, clock, lines, &recording);
  return recording;
}

}  // namespace

const Format kKitti = {"kitti", "image_0 or sequences/NN/image_0", recognise, list};

}  // namespace unisim::sequence
