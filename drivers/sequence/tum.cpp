// SPDX-License-Identifier: MIT
// TUM RGB-D: rgb.txt or associations.txt beside the images, groundtruth.txt.
#include "drivers/sequence/folder.hpp"
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

// Text from the start of one field to the end of another: names may hold blanks.
std::string span(const std::vector<std::string_view>& fields, size_t first, size_t last) {
  const char* begin = fields[first].data();
  return {begin, static_cast<size_t>(fields[last].data() + fields[last].size() - begin)};
}

// "time name" of rgb.txt, or the colour half of "time name time name" in either order.
bool parse_entry(const std::string& line, bool pairs, FrameEntry* entry) {
  const auto fields = split_fields(line);
  if (fields.size() < 2 || !parse_seconds(fields[0], &entry->timestamp_ns)) return false;
  size_t second = fields.size();
  int64_t other_ns = 0;
  for (size_t k = 2; pairs && k + 1 < fields.size() && second == fields.size(); ++k) {
    if (parse_seconds(fields[k], &other_ns)) second = k;
  }
  entry->path = span(fields, 1, second - 1);
  if (second < fields.size() && entry->path.rfind("depth", 0) == 0) {
    entry->timestamp_ns = other_ns;
    entry->path = span(fields, second + 1, fields.size() - 1);
  }
  return true;
}

Recording list(const OpenRequest& request) {
  const std::string list_path = find_list(request.path);
  if (list_path.empty()) {
    throw InputError(request.path +
                     ": no rgb.txt or associations.txt here: give the folder that has one");
  }
  const bool pairs = base_name(list_path) != "rgb.txt";
  Recording recording;
  int64_t skipped = 0;
  for (const TextLine& line : read_lines(list_path)) {
    FrameEntry entry{};
    if (parse_entry(line.text, pairs, &entry)) {
      entry.path = join(request.path, entry.path);
      recording.frames.push_back(std::move(entry));
    } else {
      ++skipped;
    }
  }
  if (recording.frames.empty()) {
    throw InputError(list_path + ": no line of the form 'time name': nothing to read");
  }
  if (skipped > 0) {
    add_note(&recording,
             list_path + ": " + std::to_string(skipped) + " lines skipped: not 'time name'");
  }
  const std::string truth_path = join(request.path, "groundtruth.txt");
  if (is_file(truth_path)) read_ground_truth(truth_path, PoseFormat::kTum, &recording);
  return recording;
}

}  // namespace

const Format kTum = {"tum", "rgb.txt or associations.txt", recognise, list};

}  // namespace unisim::sequence
