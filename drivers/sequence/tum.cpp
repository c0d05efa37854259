// SPDX-License-Identifier: MIT
// TUM RGB-D: rgb.txt or associations.txt beside the images, groundtruth.txt.
#include "drivers/sequence/folder.hpp"
#include "drivers/sequence/frame_list.hpp"
#include "drivers/sequence/recording.hpp"
#include "drivers/sequence/text_file.hpp"

namespace unisim::sequence {
namespace {

constexpr const char* kListNames[] = {"rgb.txt", "associations.txt", "associate.txt",
                                      "association.txt"};

std::string find_list(const std::string& folder) {
  for (const char* name : kListNames) {
    const std::string path = join(folder, name);
    if (is_file(path)) return path;
  }
  return {};
}

bool recognise(const std::string& path) { return !find_list(path).empty(); }

Recording list(const OpenRequest& request) {
  const std::string list_path = find_list(request.path);
  if (list_path.empty()) {
    throw InputError(request.path +
                     ": no rgb.txt or associations.txt here: give the folder that has one");
  }
  Recording recording;
  read_frame_list(list_path, TimeUnit::kSeconds, {request.path, join(request.path, "rgb")},
                  &recording);
  const std::string truth_path = join(request.path, "groundtruth.txt");
  if (is_file(truth_path)) read_ground_truth(truth_path, PoseFormat::kTum, &recording);
  return recording;
}

}  // namespace

const Format kTum = {"tum", "rgb.txt or associations.txt", recognise, list};

}  // namespace unisim::sequence
