// SPDX-License-Identifier: MIT
// What an odometer has said: where it was, or how far it had gone, at times.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>

namespace unisim::pipeline {

/// How far an odometer has come.
struct Travelled {
  std::array<double, 3> position{};  ///< metres, in a frame of its own; with has_positions()
  double path = 0.0;                 ///< metres gone since the first entry
  double sigma = 0.0;                ///< metres: what all of the path together may be off by
  int32_t stretch = 0;               ///< what lies between two stretches is not known
};

/// How far the camera went between two times.
struct OdometryStep {
  int64_t from_ns = 0;
  int64_t to_ns = 0;
  double metres = 0.0;
  double sigma = 0.0;  ///< standard deviation over the path
};

/// Where the camera was, by an odometer.
struct OdometryPosition {
  int64_t time_ns = 0;
  std::array<double, 3> position{};  ///< metres, in a frame of the odometer's own
};

/// Entries by time, straight lines between them: read from a file at once, or added while a run
/// goes, the newest kept.
class Odometry {
 public:
  /// Entries that are kept of those added: minutes of most robots.
  static constexpr size_t kMostSteps = 8192;

  /// Lines of one kind, times in seconds and growing, # begins a comment:
  ///     time path            how far it has gone, for wheels that know no direction
  ///     time x y [z]         where it was
  ///     time x y z qx qy qz qw   the same (TUM), the rotation is not used
  /// @throws sequence::InputError
  static Odometry read(const std::string& path);

  /// A step that begins where the last one ended, or later: then what is between is not known.
  void add(const OdometryStep& step);
  /// A position, later than those before. What is between two that no vehicle goes between is not
  /// known: the odometer has been set back.
  void add(const OdometryPosition& position);
  /// Nothing is known of this time yet: later steps may reach it.
  bool ends_before(int64_t timestamp_ns) const;

  /// Positions are known, not only the path.
  bool has_positions() const { return has_positions_; }
  /// @return false: outside of the entries, or in a gap of more than a second
  bool at(int64_t timestamp_ns, Travelled* travelled) const;

 private:
  struct Entry {
    double time_s = 0.0;
    Travelled travelled;
  };
  void keep(const Entry& newest);

  std::deque<Entry> entries_;
  bool has_positions_ = false;
};

}  // namespace unisim::pipeline
