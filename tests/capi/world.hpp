// SPDX-License-Identifier: MIT
// A made-up camera run with exact predictions in random units, fed to a session through unisim.h.
#pragma once

#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "core/lie/sim3.hpp"
#include "unisim/unisim.h"

namespace unisim::test {

unisim_sim3 to_c(const Sim3& T);
Sim3 from_c(const unisim_sim3& T);

/// Depth pixels and the map that points at them.
class Depth {
 public:
  Depth() = default;
  Depth(std::vector<float> pixels, int32_t width) : pixels_(std::move(pixels)), width_(width) {}
  unisim_depth_map map() const {
    return {pixels_.data(), nullptr, width_, static_cast<int32_t>(pixels_.size()) / width_};
  }
  std::vector<float>& pixels() { return pixels_; }

 private:
  std::vector<float> pixels_;
  int32_t width_ = 1;
};

/// Noise of predictions; 0: exact.
struct Noise {
  double rotation = 0.0;     ///< rad per pair and view
  double translation = 0.0;  ///< over mean depth
  double depth = 0.0;        ///< log scale of each depth map
  double unit = 0.3;         ///< standard deviation of the log unit of each inference
};

/// Two-view prediction with its own memory.
struct Pair {
  unisim_two_view two_view;
  Depth depth_i;
  Depth depth_j;
};

/// Multi-view prediction with its own memory.
struct Views {
  std::vector<int32_t> ids;
  std::vector<unisim_sim3> T_submap_kf;
  std::vector<Depth> depth;
  std::vector<unisim_depth_map> maps;
  double center_sigma = 0.0;
  unisim_submap submap() const;
};

/// True poses (scale 1) and depth; camera walks on a circle once around and back to its start.
class World {
 public:
  World(int32_t keyframes, uint32_t seed, const Noise& noise = {});

  int32_t size() const { return static_cast<int32_t>(truth_.size()); }
  const Sim3& truth(int32_t id) const { return truth_[static_cast<size_t>(id)]; }
  /// Predictions of one inference, a new random unit each time.
  Pair pair(int32_t i) { return pair(i, i + 1); }
  Pair pair(int32_t i, int32_t j);
  Views views(const std::vector<int32_t>& ids);

 private:
  Depth depth(int32_t id, double unit);
  Sim3 pose(const Sim3& T, double unit);
  double normal(double sigma);

  std::mt19937 random_;
  Noise noise_;
  std::vector<Sim3> truth_;
  std::vector<std::vector<float>> depth_;
};

/// Measurements of a good predictor.
inline constexpr Noise kNoise = {0.004, 0.002, 0.02, 0.3};

/// A session with its arena.
class Host {
 public:
  explicit Host(const unisim_config& config);
  ~Host() { unisim_session_destroy(session_); }
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  unisim_session* session() const { return session_; }
  operator unisim_session*() const { return session_; }

  int32_t add_keyframe();
  int32_t add_keyframe_at(int64_t timestamp_ns);
  /// The session has been loaded with so many keyframes.
  void go_on(int32_t keyframes) { keyframes_ = keyframes; }
  unisim_status add_pair(const Pair& pair);
  unisim_status reject_pair();
  int32_t add_submap(const Views& views);
  int32_t add_loop(const Views& views);
  unisim_report optimize(int32_t iterations = 50);
  unisim_pose pose(int32_t id) const;
  unisim_session_info info() const;
  /// Next open request of a kind; kind 0 when there is none.
  unisim_request next(uint32_t kinds) const;
  /// Feed `count` more keyframes with their pairs and windows.
  void feed(World& world, int32_t count);

 private:
  std::unique_ptr<unsigned char[]> arena_;
  unisim_session* session_ = nullptr;
  int32_t keyframes_ = 0;
};

unisim_config default_config();
/// Windows of 8 keyframes that overlap by 2; 0 window_submaps: the full batch.
unisim_config small_windows(int32_t window_submaps);

std::vector<int32_t> ids(int32_t first, int32_t count);
/// Keyframes of a loop: `half` from a and `half` from b on.
std::vector<int32_t> both(int32_t a, int32_t b, int32_t half = 4);

/// Feed `count` more keyframes with their pairs alone.
void feed_pairs(Host& host, World& world, int32_t count);

/// Feed `count` more keyframes and optimise whenever a window has come.
void feed(Host& host, World& world, int32_t count);

/// Largest distance between a keyframe's position and the truth carried into the session's world by
/// the first keyframe; lengths of the true world.
double worst_position_error(const Host& host, const World& world, int32_t keyframes);

}  // namespace unisim::test
