// SPDX-License-Identifier: MIT
// Known distances between keyframes, turned into metres per unit of the submaps that see them.
#pragma once

#include <cstdint>

#include "core/base/arena.hpp"
#include "core/base/fixed_vector.hpp"
#include "core/map/map.hpp"

namespace unisim {

/// A measured distance between the centres of two keyframes.
struct Distance {
  int32_t i = -1;  ///< earlier keyframe
  int32_t j = -1;
  double metres = 0.0;
  double sigma = 0.0;  ///< standard deviation of its logarithm
};

/// Counters.
struct DistanceCounts {
  int32_t taken = 0;    ///< that say how long a metre is
  int32_t refused = 0;  ///< far from what those around them say, or shorter than the map can tell
  int32_t lost = 0;     ///< their keyframes left before any submap saw them
};

/// A window that sees both keyframes gives the distance in its own unit, by its own measurement: so
/// a distance needs no poses and has no linearisation. Those of one window are fused, after the
/// ones that a wheel's slip has spoilt are found among their neighbours. A distance longer than a
/// window is measured on the map as it is, and counts for all submaps on its way.
class DistanceBook {
 public:
  DistanceBook(Arena& arena, int32_t nodes, Map& map)
      : distances_(arena, kMost),
        group_(arena.take<ScaleEvidence>(kMost)),
        values_(arena.take<ScaleEvidence>(kMost + kMemory)),
        way_(arena, nodes),
        map_(map) {}

  /// Both keyframes are kept. When the book is full the oldest distance is closed.
  void add(const Distance& distance);
  /// Give the map's metric scale what is known by now.
  void settle();
  /// The map has been optimised: lengths on it mean something.
  void note_solved() { solved_submaps_ = map_.submaps.next_id(); }
  /// Nothing is waiting and nothing is open.
  bool empty() const { return distances_.empty(); }
  /// Those that are open included.
  DistanceCounts counts() const;
  /// Distances that no submap sees yet.
  int32_t waiting() const;

  void visit(Archive* archive);

  /// By how much slips may have moved the scale of a segment, log: what they would have done to it
  /// had they counted fully, beyond its noise, halved.
  double doubt(int32_t segment) const;

  /// World scales of a segment are another factor's.
  void rescale_world(int32_t segment, int32_t into, double log_factor);

 private:
  static constexpr int32_t kMost = 256;   // distances that wait or are open
  static constexpr int32_t kMemory = 15;  // closed ones that the next are compared with
  static constexpr int32_t kAround = 12;  // of those before and after that one is compared with

  struct Entry {
    Distance distance;
    int32_t submap = -1;  // whose unit it is measured in, -1: not yet
    ScaleEvidence world;  // as last judged: its views leave first; not known: too short to tell
    double weight = 0.0;  // how far it agrees with those around it
  };
  /// Metres in the world's unit, of a distance that is closed.
  struct Remembered {
    int32_t segment = -1;
    ScaleEvidence world;
  };

  void visit_entry(Archive* archive, Entry* entry);
  int32_t seen_by(const Distance& distance) const;
  int32_t view_of(const Submap& submap, int32_t keyframe) const;
  bool is_open(int32_t submap) const;
  ScaleEvidence measure(const Entry& entry) const;
  void open(int32_t submap);
  void close(int32_t submap);
  bool belongs(const Entry& entry, int32_t segment) const;
  int32_t gather(int32_t segment);
  void judge(int32_t segment);
  Consensus around(int32_t place, int32_t count) const;
  void remember(int32_t segment, const ScaleEvidence& world);
  void close_retired();
  void place_waiting();
  bool measure_on_map(const Distance& distance);
  int32_t node_of(int32_t keyframe) const;
  void collect_way(const Distance& distance);
  void erase(int32_t k);

  FixedVector<Entry> distances_;
  Span<ScaleEvidence> group_;
  Span<ScaleEvidence> values_;  // of one segment, in the order they came
  FixedVector<int32_t> way_;
  Remembered memory_[kMemory];
  int32_t remembered_ = 0;
  int32_t solved_submaps_ = 0;  // submaps that were there at the last optimisation
  Map& map_;
  DistanceCounts counts_;
};

}  // namespace unisim
