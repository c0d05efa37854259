// SPDX-License-Identifier: MIT
// What an odometer has said: where it was, or how far it had gone, at times.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace unisim::pipeline {

/// How far an odometer has come.
struct Travelled {
  std::array<double, 3> position{};  ///< metres, in a frame of its own; with has_positions()
  double path = 0.0;                 ///< metres gone since the first entry
};

/// Entries by time, straight lines between them. All of it is read at once.
class Odometry {
 public:
  /// Lines of one kind, times in seconds and growing, # begins a comment:
  ///     time path            how far it has gone, for wheels that know no direction
  ///     time x y [z]         where it was
  ///     time x y z qx qy qz qw   the same (TUM), the rotation is not used
  /// @throws sequence::InputError
  static Odometry read(const std::string& path);

  /// Positions are known, not only the path.
  bool has_positions() const { return has_positions_; }
  /// @return false: outside of the entries, or in a gap of more than a second
  bool at(int64_t timestamp_ns, Travelled* travelled) const;

 private:
  struct Entry {
    double time_s = 0.0;
    Travelled travelled;
  };
  std::vector<Entry> entries_;
  bool has_positions_ = false;
};

}  // namespace unisim::pipeline
