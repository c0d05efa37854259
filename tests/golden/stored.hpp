// SPDX-License-Identifier: MIT
// Reading of the stored numbers.
#pragma once

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/unit/core_support.hpp"

namespace unisim_test {

/// Words of each line of a stored file, comments left out.
inline std::vector<std::vector<std::string>> stored_lines(const std::string& name) {
  std::ifstream file(std::string(UNISIM_GOLDEN) + "/" + name);
  if (!file) throw std::runtime_error("missing stored file " + name);
  std::vector<std::vector<std::string>> lines;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    lines.emplace_back();
    for (std::string word; words >> word;) lines.back().push_back(word);
  }
  return lines;
}

/// Takes numbers from a line one after another.
class Numbers {
 public:
  explicit Numbers(const std::vector<std::string>& words, size_t first = 0)
      : words_(words), at_(first) {}
  double next() { return std::stod(words_.at(at_++)); }
  int32_t next_index() { return std::stoi(words_.at(at_++)); }
  const std::string& word() { return words_.at(at_++); }
  unisim::Vec7 vector() {
    unisim::Vec7 v;
    for (int i = 0; i < 7; ++i) v(i) = next();
    return v;
  }
  /// Row by row.
  unisim::Mat7 matrix() {
    unisim::Mat7 m;
    for (int r = 0; r < 7; ++r) m.row(r) = vector().transpose();
    return m;
  }
  /// qx qy qz qw tx ty tz s
  unisim::Sim3 pose() {
    unisim::Sim3 T;
    T.q.x() = next();
    T.q.y() = next();
    T.q.z() = next();
    T.q.w() = next();
    for (int i = 0; i < 3; ++i) T.t(i) = next();
    T.s = next();
    return T;
  }

 private:
  const std::vector<std::string>& words_;
  size_t at_;
};

}  // namespace unisim_test
