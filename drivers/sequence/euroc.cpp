// SPDX-License-Identifier: MIT
// EuRoC ASL: mav0/cam0/data.csv with data/, ground truth of the body in
// state_groundtruth_estimate0.
#include <algorithm>

#include "drivers/sequence/folder.hpp"
#include "drivers/sequence/frame_list.hpp"
#include "drivers/sequence/recording.hpp"
#include "drivers/sequence/text_file.hpp"

namespace unisim::sequence {
namespace {

// The folder that holds cam0, "" if there is none: mav0 of the given folder, or the folder itself.
std::string find_mav(const std::string& path) {
  for (const std::string& mav : {join(path, "mav0"), path}) {
    const std::string camera = join(mav, "cam0");
    if (is_file(join(camera, "data.csv")) || !list_images(join(camera, "data")).empty()) return mav;
  }
  return {};
}

bool recognise(const std::string& path) { return is_folder(path) && !find_mav(path).empty(); }

// Without a list the names of the images are their times.
void list_by_name(const std::string& folder, Recording* recording) {
  std::vector<TimedName> images;
  int64_t others = 0;
  for (const std::string& name : list_images(folder)) {
    int64_t ignored = 0;
    const std::string time = name.substr(0, name.find_last_of('.'));
    if (parse_time(time, TimeUnit::kNanoseconds, &ignored)) {
      images.push_back({time, join(folder, name)});
    } else {
      ++others;
    }
  }
  if (others > 0) {
    add_note(recording,
             folder + ": " + std::to_string(others) + " images left out: their name is no time");
  }
  recording->list_path = folder;
  add_timed_images(images, TimeUnit::kNanoseconds, recording);
}

// T_BS of sensor.yaml: sixteen numbers in brackets after "data:", body from camera.
bool read_extrinsics(const std::string& path, FilePose* T_body_cam) {
  std::string text;
  if (!is_file(path)) return false;
  for (const TextLine& line : read_lines(path)) text += line.text + ' ';
  const size_t matrix = text.find("T_BS");
  const size_t open = matrix == std::string::npos ? matrix : text.find('[', matrix);
  const size_t close = open == std::string::npos ? open : text.find(']', open);
  if (close == std::string::npos) return false;
  const auto fields = split_fields(std::string_view(text).substr(open + 1, close - open - 1), true);
  double rows[16];
  if (fields.size() != 16) return false;
  for (size_t k = 0; k < 16; ++k) {
    if (!parse_number(fields[k], &rows[k])) return false;
  }
  return pose_from_matrix(rows, T_body_cam);
}

FilePose compose(const FilePose& a, const FilePose& b) {
  FilePose out = a;
  for (int i = 0; i < 3; ++i) {
    const double* row = a.rotation + 3 * i;
    for (int j = 0; j < 3; ++j) {
      out.rotation[3 * i + j] =
          row[0] * b.rotation[j] + row[1] * b.rotation[3 + j] + row[2] * b.rotation[6 + j];
    }
    out.translation[i] +=
        row[0] * b.translation[0] + row[1] * b.translation[1] + row[2] * b.translation[2];
  }
  return out;
}

// The file has poses of the body: the camera's need T_BS.
void add_ground_truth(const std::string& mav, Recording* recording) {
  const std::string path = join(mav, "state_groundtruth_estimate0/data.csv");
  if (!is_file(path)) return;
  FilePose T_body_cam{};
  if (!read_extrinsics(join(mav, "cam0/sensor.yaml"), &T_body_cam)) {
    add_note(recording, "no ground truth: " + join(mav, "cam0/sensor.yaml") + " has no T_BS");
    return;
  }
  try {
    const PoseFile file = read_pose_file(path, PoseFormat::kEuroc);
    for (const FilePose& pose : file.poses) {
      recording->truth.poses.push_back(to_stamped_pose(compose(pose, T_body_cam)));
    }
    if (file.foreign_unit) note_unit(path, file.unit, recording);
    recording->truth.skipped = file.skipped;
    recording->truth.path = path;
  } catch (const InputError& error) {
    add_note(recording, std::string("no ground truth: ") + error.what());
  }
  finish_ground_truth(recording);
}

Recording list(const OpenRequest& request) {
  const std::string mav = find_mav(request.path);
  if (mav.empty()) {
    throw InputError(request.path +
                     ": no mav0/cam0 with data.csv or data/*.png: give the folder above mav0");
  }
  const std::string camera = join(mav, "cam0");
  Recording recording;
  const std::string images = join(camera, "data");
  const std::string csv = join(camera, "data.csv");
  if (is_file(csv)) {
    read_frame_list(csv, TimeUnit::kNanoseconds, {images, camera, mav}, &recording);
  } else {
    list_by_name(images, &recording);
  }
  if (recording.frames.empty()) {
    throw InputError(camera + ": no image with a time for its name: nothing to read");
  }
  add_ground_truth(mav, &recording);
  return recording;
}

}  // namespace

const Format kEuroc = {"euroc", "mav0/cam0/data.csv or mav0/cam0/data/", recognise, list};

}  // namespace unisim::sequence
