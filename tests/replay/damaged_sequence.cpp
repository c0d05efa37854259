// SPDX-License-Identifier: MIT
// A rendered sequence that a test may damage.
#include "tests/replay/damaged_sequence.hpp"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "tests/replay/program.hpp"

namespace unisim::testing {
namespace fs = std::filesystem;

DamagedSequence::DamagedSequence() {
  fs::copy(fs::path(rendered_sequence()) / "rgb", path() + "/rgb", fs::copy_options::recursive);
  for (const char* name : {"rgb.txt", "groundtruth.txt"}) {
    fs::copy_file(fs::path(rendered_sequence()) / name, path() + "/" + name);
  }
  std::istringstream list(read_file(path() + "/rgb.txt"));
  for (std::string line; std::getline(list, line);) {
    if (!line.empty() && line[0] != '#') lines.push_back(line);
  }
}

std::string DamagedSequence::image(size_t k) const {
  return path() + "/" + lines.at(k).substr(lines.at(k).find(' ') + 1);
}

double DamagedSequence::time(size_t k) const { return std::stod(lines.at(k)); }

void DamagedSequence::set_time(size_t k, double time) {
  std::ostringstream line;
  line.precision(6);
  line << std::fixed << time << lines.at(k).substr(lines.at(k).find(' '));
  lines.at(k) = line.str();
}

void DamagedSequence::save_list() const {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  write_file(path() + "/rgb.txt", text);
}

void DamagedSequence::spread_times(double seconds) {
  for (size_t k = 1; k < lines.size(); ++k) {
    set_time(k, time(0) + seconds * static_cast<double>(k));
  }
  save_list();
}

int lines_in(const std::string& text) {
  return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

int poses_in(const std::string& path) {
  std::istringstream text(read_file(path));
  int count = 0;
  for (std::string line; std::getline(text, line);) count += line.empty() || line[0] == '#' ? 0 : 1;
  return count;
}

std::vector<std::string> arguments(const std::string& sequence, const std::string& out) {
  return {sequence, "--out", out, "--stride", "4", "--quiet"};
}

std::vector<std::string> with(std::vector<std::string> list, const std::vector<std::string>& more) {
  list.insert(list.end(), more.begin(), more.end());
  return list;
}

}  // namespace unisim::testing
