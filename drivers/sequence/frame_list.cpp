// SPDX-License-Identifier: MIT
// Lists of images with their times, in the spellings that recorders and spreadsheets give them.
#include "drivers/sequence/frame_list.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>

#include "drivers/sequence/folder.hpp"
#include "drivers/sequence/list_line.hpp"
#include "drivers/sequence/text_file.hpp"

namespace unisim::sequence {
namespace {

using ListLine = std::vector<ListedName>;

constexpr const char* kEndings[] = {"", ".png", ".jpg", ".jpeg", ".bmp", ".pgm"};

// Where a listed file is; the first place if it is nowhere, for the message of the frame.
std::string find_listed(std::string name, const std::vector<std::string>& folders) {
  for (const char* ending : kEndings) {
    for (const std::string& folder : folders) {
      const std::string path = name.front() == '/' ? name : join(folder, name + ending);
      if (is_file(path)) return path;
    }
  }
  if (name.find('\\') != std::string::npos) {
    std::replace(name.begin(), name.end(), '\\', '/');
    return find_listed(name, folders);
  }
  return name.front() == '/' ? name : join(folders.front(), name);
}

bool names_depth(std::string_view name) {
  std::string small(name);
  for (char& c : small) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return small.find("depth") != std::string::npos;
}

// Depth is stored as PNG with one channel of 16 bits: bytes 24 and 25 say so.
bool is_depth_file(const std::string& path) {
  char head[26] = {};
  std::ifstream file(path, std::ios::binary);
  file.read(head, sizeof head);
  return file.gcount() == sizeof head && std::string_view(head + 1, 3) == "PNG" && head[24] == 16 &&
         head[25] == 0;
}

// The column with the colour images: the first that does not name or hold depth. What is the same
// in both names, such as the folder of the recording, says nothing.
size_t colour_column(const ListLine& line, const std::vector<std::string>& folders) {
  const std::string& a = line[0].name;
  const std::string& b = line[1].name;
  const size_t shortest = std::min(a.size(), b.size());
  const auto length =
      std::mismatch(a.begin(), a.begin() + static_cast<std::ptrdiff_t>(shortest), b.begin()).first -
      a.begin();
  const size_t slash = a.substr(0, static_cast<size_t>(length)).rfind('/');
  const size_t common = slash == std::string::npos ? 0 : slash + 1;
  const bool depth_a = names_depth(std::string_view(a).substr(common));
  const bool depth_b = names_depth(std::string_view(b).substr(common));
  if (depth_a != depth_b) return depth_a ? 1 : 0;
  return is_depth_file(find_listed(a, folders)) && !is_depth_file(find_listed(b, folders)) ? 1 : 0;
}

struct LeftOut {
  int64_t count = 0;
  std::string first;
};

LeftOut take_lines(const std::string& path, std::vector<ListLine>* good) {
  LeftOut bad;
  for (const TextLine& line : read_lines(path)) {
    ListLine names = parse_list_line(line.text);
    if (names.empty()) {
      if (bad.count++ == 0) {
        bad.first = path + ":" + std::to_string(line.number) + ": '" + line.text.substr(0, 60) +
                    "' is not 'time name'";
      }
    } else {
      good->push_back(std::move(names));
    }
  }
  return bad;
}

void check_lines(const std::string& path, const LeftOut& bad, size_t good, Recording* recording) {
  const std::string total = std::to_string(bad.count + static_cast<int64_t>(good));
  const std::string remark = bad.first + ": " + std::to_string(bad.count) + " of " + total +
                             " lines skipped: expected a time and the name of an image";
  if (good == 0 && bad.count == 0) {
    throw InputError(path + ": no line of the form 'time name': nothing to read");
  }
  if (bad.count > static_cast<int64_t>(good)) throw InputError(remark);
  if (bad.count > 0) add_note(recording, remark);
}

}  // namespace

void add_timed_images(const std::vector<TimedName>& images, TimeUnit own, Recording* recording) {
  std::vector<double> times(images.size());
  for (size_t k = 0; k < images.size(); ++k) parse_number(images[k].time, &times[k]);
  const TimeUnit unit = guess_unit(times, own, kLongestImageStepS);
  if (unit != own) note_unit(recording->list_path, unit, recording);
  int64_t out_of_range = 0;
  for (const TimedName& image : images) {
    int64_t ns = 0;
    if (parse_time(image.time, unit, &ns)) {
      recording->frames.push_back({ns, image.path});
    } else {
      ++out_of_range;
    }
  }
  if (out_of_range > 0) {
    add_note(recording, std::to_string(out_of_range) + " images left out: time out of range");
  }
}

void read_frame_list(const std::string& path, TimeUnit own, const std::vector<std::string>& folders,
                     Recording* recording) {
  std::vector<ListLine> lines;
  const LeftOut bad = take_lines(path, &lines);
  check_lines(path, bad, lines.size(), recording);
  const auto pair = std::find_if(lines.begin(), lines.end(),
                                 [](const ListLine& line) { return line.size() > 1; });
  const size_t column = pair == lines.end() ? 0 : colour_column(*pair, folders);
  std::vector<TimedName> images;
  int64_t hidden = 0;
  for (const ListLine& line : lines) {
    const ListedName& entry = line[std::min(column, line.size() - 1)];
    if (is_hidden(base_name(entry.name))) {
      ++hidden;
    } else {
      images.push_back({entry.time, find_listed(entry.name, folders)});
    }
  }
  if (hidden > 0) {
    add_note(recording, path + ": " + std::to_string(hidden) +
                            " lines skipped: names that begin with a dot are no input");
  }
  if (images.empty()) throw InputError(path + ": names hidden files only: nothing to read");
  recording->list_path = path;
  add_timed_images(images, own, recording);
}

}  // namespace unisim::sequence
