// SPDX-License-Identifier: MIT
// Known distances between keyframes, turned into metres per unit of the submaps that see them.
#include "core/map/distance_book.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/math.hpp"
#include "core/graph/metric.hpp"

namespace unisim {
namespace {

// Where the views of a window are, over how far they are apart: windows of real recordings are
// right to 1-6 mm over half a metre to a metre.
constexpr double kPlaceSigma = 0.005;
// A length on the map over its error, the same for a way over several submaps.
constexpr double kWaySigma = 0.005;
// Shorter than this number of standard deviations, a length says nothing, and its logarithm is
// biased.
constexpr double kLeastWidths = 5.0;

}  // namespace

void DistanceBook::add(const Distance& distance) {
  if (distances_.full()) {
    const int32_t submap = distances_[0].submap;
    if (submap >= 0) {
      close(submap);
    } else {
      erase(0);
      ++counts_.lost;
    }
  }
  Entry entry;
  entry.distance = distance;
  static_cast<void>(distances_.push_back(entry));
}

void DistanceBook::erase(int32_t k) {
  for (; k + 1 < distances_.size(); ++k) distances_[k] = distances_[k + 1];
  distances_.pop_back();
}

int32_t DistanceBook::waiting() const {
  int32_t count = 0;
  for (const Entry& entry : distances_) count += entry.submap < 0 ? 1 : 0;
  return count;
}

bool DistanceBook::is_open(int32_t submap) const {
  return map_.submaps.has(submap) && !map_.submaps[submap].place.retired;
}

int32_t DistanceBook::view_of(const Submap& submap, int32_t keyframe) const {
  for (int32_t k = 0; k < submap.count; ++k) {
    const SubmapView& view = map_.submaps.view(submap, k);
    if (view.keyframe == keyframe && view.used) return k;
  }
  return -1;
}

/// Oldest window that sees both ends and still has its views, -1: none.
int32_t DistanceBook::seen_by(const Distance& distance) const {
  for (int32_t k = 0; k < map_.submaps.size(); ++k) {
    const Submap& submap = map_.submaps.at(k);
    if (submap.is_loop || submap.place.retired || submap.place.node < 0) continue;
    if (view_of(submap, distance.i) >= 0 && view_of(submap, distance.j) >= 0) return submap.id;
  }
  return -1;
}

/// Metres per unit of the entry's window; nothing where the two views are too near each other.
ScaleEvidence DistanceBook::measure(const Entry& entry) const {
  const Submap& submap = map_.submaps[entry.submap];
  const Vec3 p = map_.submaps.view(submap, view_of(submap, entry.distance.i)).T_submap_kf.t;
  const Vec3 q = map_.submaps.view(submap, view_of(submap, entry.distance.j)).T_submap_kf.t;
  double extent = 0.0;
  for (int32_t k = 0; k < submap.count; ++k) {
    extent = std::max(extent, map_.submaps.view(submap, k).T_submap_kf.t.norm());
  }
  const double length = (q - p).norm();
  const double place_sigma = kPlaceSigma * extent;
  if (!(length > kLeastWidths * place_sigma)) return {};
  const double relative = place_sigma / length;
  const double variance = entry.distance.sigma * entry.distance.sigma + 2.0 * relative * relative;
  return {log_metres_per_unit(entry.distance.metres, p, q), 1.0 / variance};
}

void DistanceBook::remember(int32_t segment, const ScaleEvidence& world) {
  memory_[remembered_ % kMemory] = {segment, world};
  ++remembered_;
  if (remembered_ == 2 * kMemory) remembered_ = kMemory;
}

bool DistanceBook::belongs(const Entry& entry, int32_t segment) const {
  return entry.submap >= 0 && map_.submaps[entry.submap].segment == segment;
}

/// What is said of a segment, by closed ones and open ones, in the world's unit. @return their
/// number
int32_t DistanceBook::gather(int32_t segment) {
  int32_t count = 0;
  for (int32_t k = 0; k < kMemory; ++k) {
    const Remembered& old = memory_[(remembered_ + k) % kMemory];
    if (old.segment == segment) values_[count++] = old.world;
  }
  for (const Entry& entry : distances_) {
    if (belongs(entry, segment) && entry.world.known()) values_[count++] = entry.world;
  }
  return count;
}

/// What those before and after number `place` of the gathered ones say together with it. Not all of
/// them: scale that drifts is no slip.
Consensus DistanceBook::around(int32_t place, int32_t count) const {
  const int32_t first = std::max<int32_t>(place - kAround, 0);
  const int32_t end = std::min<int32_t>(place + kAround + 1, count);
  ScaleEvidence near[2 * kAround + 1];
  for (int32_t k = first; k < end; ++k) near[k - first] = values_[k];
  return consensus_of({near, end - first});
}

/// How far the open distances of a segment agree with those around them.
void DistanceBook::judge(int32_t segment) {
  for (Entry& entry : distances_) {
    if (!belongs(entry, segment)) continue;
    const Submap& submap = map_.submaps[entry.submap];
    entry.world = measure(entry).of_unit(-math::log(map_.submap_pose(submap).s));
    entry.weight = 0.0;
  }
  const int32_t count = gather(segment);
  int32_t place = count;
  for (int32_t k = distances_.size() - 1; k >= 0; --k) {
    Entry& entry = distances_[k];
    if (!belongs(entry, segment) || !entry.world.known()) continue;
    --place;
    entry.weight = around(place, count).weight(values_[place]);
  }
}

double DistanceBook::doubt(int32_t segment) const {
  ScaleEvidence all;
  ScaleEvidence weighted;
  for (const Entry& entry : distances_) {
    // One whose window has just left is closed by the next settle().
    if (!is_open(entry.submap) || !belongs(entry, segment) || !entry.world.known()) continue;
    all = fuse(all, entry.world);
    weighted = fuse(weighted, {entry.world.log_metres, entry.world.information * entry.weight});
  }
  if (!weighted.known()) return 0.0;
  const double moved = std::abs(all.log_metres - weighted.log_metres);
  return 0.5 * std::max(0.0, moved - 1.0 / std::sqrt(all.information));
}

/// What the open distances of a window say together.
void DistanceBook::open(int32_t submap) {
  int32_t count = 0;
  for (const Entry& entry : distances_) {
    if (entry.submap != submap || !(entry.weight > 0.0)) continue;
    const ScaleEvidence one = measure(entry);
    group_[count++] = {one.log_metres, one.information * entry.weight};
  }
  map_.metric.set_open(map_.submaps[submap].place.node, fuse({group_.data(), count}));
}

/// The window's distances are known together from now on.
void DistanceBook::close(int32_t submap) {
  const bool kept = map_.submaps.has(submap);
  if (kept) map_.metric.close(map_.submaps[submap].place.node);
  for (int32_t k = 0; k < distances_.size();) {
    const Entry entry = distances_[k];
    if (entry.submap != submap) {
      ++k;
      continue;
    }
    ++(entry.weight > 0.0 ? counts_.taken : counts_.refused);
    if (kept && entry.world.known()) remember(map_.submaps[submap].segment, entry.world);
    erase(k);
  }
}

DistanceCounts DistanceBook::counts() const {
  DistanceCounts all = counts_;
  for (const Entry& entry : distances_) {
    if (entry.submap >= 0) ++(entry.weight > 0.0 ? all.taken : all.refused);
  }
  return all;
}

int32_t DistanceBook::node_of(int32_t keyframe) const {
  if (!map_.keyframes.has(keyframe)) return -1;
  const Keyframe& asked = map_.keyframes[keyframe];
  const int32_t submap = asked.retired() ? asked.owner : asked.best_submap;
  const bool solved = asked.posed() && submap < solved_submaps_ && map_.submaps.has(submap);
  if (!solved || map_.submaps[submap].is_loop) return -1;
  return map_.submaps[submap].place.node;
}

/// Nodes that carry the keyframes from one end to the other, each once.
void DistanceBook::collect_way(const Distance& distance) {
  way_.clear();
  for (int32_t id = distance.i; id <= distance.j; ++id) {
    const int32_t node = node_of(id);
    const bool other = map_.keyframes[id].segment != map_.keyframes[distance.i].segment;
    bool there = node < 0 || other;
    for (const int32_t known : way_) there = there || known == node;
    if (!there && !way_.push_back(node)) return;
  }
}

/// @return false: the ends are not covered yet, or have not been optimised since
bool DistanceBook::measure_on_map(const Distance& distance) {
  const KeyframeRing& keyframes = map_.keyframes;
  if (node_of(distance.i) < 0 || node_of(distance.j) < 0) return false;
  if (keyframes[distance.i].segment != keyframes[distance.j].segment) return false;
  const Vec3 p = map_.keyframe_pose(distance.i).t;
  const Vec3 q = map_.keyframe_pose(distance.j).t;
  collect_way(distance);
  if (!((q - p).norm() > 0.0)) {
    ++counts_.refused;
    return true;
  }
  const double log_world = log_metres_per_unit(distance.metres, p, q);
  const double variance = distance.sigma * distance.sigma + kWaySigma * kWaySigma;
  const int32_t segment = keyframes[distance.i].segment;
  const int32_t count = gather(segment);
  const ScaleEvidence world = {log_world, 1.0 / variance};
  values_[count] = world;
  remember(segment, world);
  const double weight = around(count, count + 1).weight(world);
  if (!(weight > 0.0)) {
    ++counts_.refused;
    return true;
  }
  for (const int32_t node : way_) {
    const ScaleEvidence part = {log_world, weight * world.information / way_.size()};
    map_.metric.add(node, part.of_unit(math::log(map_.graph.pose(node).s)));
  }
  ++counts_.taken;
  return true;
}

void DistanceBook::rescale_world(int32_t segment, int32_t into, double log_factor) {
  for (Remembered& old : memory_) {
    if (old.segment == segment) old = {into, old.world.of_unit(-log_factor)};
  }
}

/// Windows that have left since the last call say no more than they did.
void DistanceBook::close_retired() {
  for (int32_t k = 0; k < distances_.size();) {
    const int32_t submap = distances_[k].submap;
    if (submap < 0 || is_open(submap)) {
      ++k;
    } else {
      close(submap);
      k = 0;
    }
  }
}

/// What has waited and is seen by now.
void DistanceBook::place_waiting() {
  for (int32_t k = 0; k < distances_.size();) {
    Entry& entry = distances_[k];
    if (entry.submap < 0) entry.submap = seen_by(entry.distance);
    const bool gone = !map_.keyframes.has(entry.distance.i);
    if (entry.submap >= 0 || !(gone || measure_on_map(entry.distance))) {
      ++k;
      continue;
    }
    counts_.lost += gone ? 1 : 0;
    erase(k);
  }
}

void DistanceBook::settle() {
  close_retired();
  place_waiting();
  const auto segment_of = [&](int32_t k) {
    const int32_t submap = distances_[k].submap;
    return submap < 0 ? -1 : map_.submaps[submap].segment;
  };
  for (int32_t k = 0; k < distances_.size(); ++k) {
    bool is_first = segment_of(k) >= 0;
    for (int32_t earlier = 0; is_first && earlier < k; ++earlier) {
      is_first = segment_of(earlier) != segment_of(k);
    }
    if (is_first) judge(segment_of(k));
  }
  for (int32_t k = 0; k < map_.submaps.size(); ++k) {
    const Submap& submap = map_.submaps.at(k);
    if (!submap.is_loop && submap.place.node >= 0 && !submap.place.retired) open(submap.id);
  }
}

}  // namespace unisim
