// SPDX-License-Identifier: MIT
// Depth images of a recorded sequence: where they lie, their camera, their poses.
#include "tools/eval/depth_images.hpp"

#include <memory>

#include "drivers/common/stamp_text.hpp"
#include "drivers/sequence/folder.hpp"
#include "drivers/sequence/frame_list.hpp"
#include "drivers/sequence/sequence.h"
#include "tools/eval/depth_camera.hpp"

namespace unisim::eval {
namespace {

using Source = std::unique_ptr<unisim_source, void (*)(unisim_source*)>;

constexpr double kTumUnits = 5000.0;
constexpr double kSevenScenesUnits = 1000.0;
constexpr double kReplicaUnits = 6553.5;

Source open(const DepthRequest& request) {
  unisim_sequence_options options{};
  options.struct_size = sizeof options;
  options.format = request.format.c_str();
  char message[512] = "";
  Source source(unisim_sequence_open(request.path.c_str(), &options, message, sizeof message),
                [](unisim_source* opened) { opened->destroy(opened); });
  if (source == nullptr) throw InputError(message);
  return source;
}

Trajectory truth_of(const DepthRequest& request, unisim_source* source) {
  if (!request.ground_truth.empty()) return read_trajectory(request.ground_truth);
  const unisim_stamped_pose* poses = nullptr;
  const int64_t count = source->ground_truth(source, &poses);
  if (count == 0) {
    throw InputError(request.path +
                     ": no ground truth beside it: give its poses with --ground-truth FILE");
  }
  return make_trajectory(source->ground_truth_path(source), poses, count);
}

/// Images of depth.txt, which have times of their own.
std::vector<DepthImage> listed_images(const std::string& folder, std::vector<std::string>* notes) {
  const std::string list = sequence::join(folder, "depth.txt");
  if (!sequence::is_file(list))
    throw InputError(folder + ": no depth.txt here: give a sequence with depth images");
  sequence::Recording recording;
  sequence::read_frame_list(list, sequence::TimeUnit::kSeconds,
                            {folder, sequence::join(folder, "depth")}, &recording);
  sequence::put_in_time_order(&recording);
  *notes = recording.notes;
  std::vector<DepthImage> images;
  for (const sequence::FrameEntry& frame : recording.frames)
    images.push_back({frame.path, drivers::stamp_seconds(frame.timestamp_ns)});
  return images;
}

/// Name of the depth image beside a colour image, "" for a name of another kind.
std::string depth_beside(const std::string& colour, const std::string& format) {
  const std::string folder = sequence::parent(colour);
  const std::string name = sequence::base_name(colour);
  const std::string mark = format == "replica" ? "frame" : ".color.";
  const size_t at = name.find(mark);
  if (at == std::string::npos) return "";
  if (format != "replica") return sequence::join(folder, name.substr(0, at) + ".depth.png");
  const size_t dot = name.rfind('.');
  const size_t number = at + mark.size();
  return sequence::join(folder, "depth" + name.substr(number, dot - number) + ".png");
}

std::vector<DepthImage> images_beside(unisim_source* source, const std::string& format) {
  std::vector<DepthImage> images;
  unisim_frame frame{};
  int code = UNISIM_FRAME_OK;
  while ((code = source->next_frame(source, 0, &frame)) != UNISIM_FRAME_END) {
    if (code == UNISIM_FRAME_FAILED) throw InputError(source->message(source));
    if (code != UNISIM_FRAME_OK) continue;
    const std::string path = depth_beside(unisim_sequence_frame_path(source), format);
    if (!path.empty() && sequence::is_file(path))
      images.push_back({path, drivers::stamp_seconds(frame.timestamp_ns)});
  }
  return images;
}

}  // namespace

DepthImages find_depth_images(const DepthRequest& request) {
  const Source source = open(request);
  DepthImages found;
  found.format = source->format;
  found.units_per_metre = kSevenScenesUnits;
  if (found.format == "tum") {
    found.units_per_metre = kTumUnits;
    found.images = listed_images(request.path, &found.notes);
  } else if (found.format == "7scenes" || found.format == "replica") {
    if (found.format == "replica") found.units_per_metre = kReplicaUnits;
    found.images = images_beside(source.get(), found.format);
  } else {
    throw InputError(request.path + ": " + found.format +
                     " has no depth images: give a sequence of tum, 7scenes or replica");
  }
  if (found.images.empty())
    throw InputError(request.path + ": no depth images here: give a sequence that has them");
  found.truth = truth_of(request, source.get());
  found.camera = request.camera;
  found.camera_from = "given";
  if (found.camera.fx <= 0.0) find_depth_camera(request.path, &found);
  if (request.units_per_metre > 0.0) found.units_per_metre = request.units_per_metre;
  if (found.format == "7scenes") {
    found.notes.push_back(
        "depth images are taken as of the camera whose poses are given; those of the original "
        "7-Scenes are of another one, about 25 mm beside the colour camera");
  }
  return found;
}

}  // namespace unisim::eval
