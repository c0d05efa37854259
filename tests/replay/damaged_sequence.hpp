// SPDX-License-Identifier: MIT
// A rendered sequence that a test may damage, and what tests ask of results.
#pragma once

#include <string>
#include <vector>

#include "tests/support/temp_folder.hpp"

namespace unisim::testing {

/// A copy of the rendered sequence: images, rgb.txt and ground truth.
class DamagedSequence {
 public:
  DamagedSequence();

  std::string path() const { return folder_ / "."; }
  std::string image(size_t k) const;
  double time(size_t k) const;
  void set_time(size_t k, double time);
  void save_list() const;

  /// Frames `seconds` apart, from the first.
  void spread_times(double seconds);

  std::vector<std::string> lines;  ///< of rgb.txt

 private:
  TempFolder folder_;
};

int lines_in(const std::string& text);

/// Poses of a TUM file.
int poses_in(const std::string& path);

/// A quiet run with every fourth frame.
std::vector<std::string> arguments(const std::string& sequence, const std::string& out);

std::vector<std::string> with(std::vector<std::string> list, const std::vector<std::string>& more);

}  // namespace unisim::testing
