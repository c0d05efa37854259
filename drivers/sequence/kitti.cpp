// SPDX-License-Identifier: MIT
// KITTI odometry: sequences/NN/image_0 with times.txt, poses/NN.txt.
#include "drivers/sequence/folder.hpp"
#include "drivers/sequence/recording.hpp"
#include "drivers/sequence/text_file.hpp"

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

std::vector<int64_t> read_times(const std::string& path) {
  std::vector<int64_t> times;
  for (const TextLine& line : read_lines(path)) {
    int64_t ns = 0;
    if (!parse_seconds(split_fields(line.text).front(), &ns)) {
      throw InputError(path + ":" + std::to_string(line.number) + ": not a time in seconds");
    }
    times.push_back(ns);
  }
  return times;
}

// Times of the frames: times.txt; else those of a ground truth with one timed line per image; else
// the usual rate.
std::vector<int64_t> frame_times(const std::string& sequence, size_t count, double fps,
                                 const std::vector<PoseFile>& poses) {
  const std::string times_path = join(sequence, "times.txt");
  std::vector<int64_t> times;
  if (is_file(times_path)) {
    times = read_times(times_path);
    if (times.size() < count) {
      throw InputError(times_path + ": " + std::to_string(times.size()) + " times for " +
                       std::to_string(count) + " images: one line per image is needed");
    }
    return times;
  }
  for (size_t k = 0; k < poses.size() && times.empty() && fps <= 0; ++k) {
    if (poses[k].format != PoseFormat::kTum || poses[k].poses.size() != count) continue;
    for (const FilePose& pose : poses[k].poses) times.push_back(pose.timestamp_ns);
  }
  for (size_t k = times.size(); k < count; ++k) {
    times.push_back(time_at_rate(static_cast<int64_t>(k), fps > 0 ? fps : kUsualFps));
  }
  return times;
}

// The first file that fits: a matrix per line belongs to the image of the same number.
void choose_ground_truth(const std::vector<std::string>& paths, const std::vector<PoseFile>& files,
                         const std::vector<int64_t>& times, Recording* recording) {
  for (size_t k = 0; k < files.size() && recording->truth.poses.empty(); ++k) {
    const bool by_number = files[k].format == PoseFormat::kKitti;
    for (const FilePose& pose : files[k].poses) {
      unisim_stamped_pose stamped = to_stamped_pose(pose);
      if (by_number) {
        const int64_t number = pose.timestamp_ns / 1000000000;
        if (number < 0 || number >= static_cast<int64_t>(times.size())) continue;
        stamped.timestamp_ns = times[static_cast<size_t>(number)];
      }
      recording->truth.poses.push_back(stamped);
    }
    recording->truth.path = paths[k];
    recording->truth.skipped = files[k].skipped;
  }
  finish_ground_truth(recording);
}

Recording list(const OpenRequest& request) {
  const std::string sequence = choose_sequence(request.path);
  const std::string images = find_images(sequence);
  Recording recording;
  std::vector<std::string> pose_paths;
  std::vector<PoseFile> pose_files;
  for (const std::string& path : find_pose_files(sequence)) {
    try {
      pose_files.push_back(read_pose_file(path));
      pose_paths.push_back(path);
    } catch (const InputError& error) {
      add_note(&recording, std::string("no ground truth: ") + error.what());
    }
  }
  const std::vector<std::string> names = list_images(images);
  const std::vector<int64_t> times = frame_times(sequence, names.size(), request.fps, pose_files);
  for (size_t k = 0; k < names.size(); ++k) {
    recording.frames.push_back({times[k], join(images, names[k])});
  }
  choose_ground_truth(pose_paths, pose_files, times, &recording);
  return recording;
}

}  // namespace

const Format kKitti = {"kitti", "image_0 or sequences/NN/image_0", recognise, list};

}  // namespace unisim::sequence
