// SPDX-License-Identifier: MIT
// An odometer beside the camera of a test's world, and what a session makes of it.
#pragma once

#include <cmath>
#include <random>

#include "tests/capi/world.hpp"
#include "tests/support/catch.hpp"

namespace unisim::test {

constexpr double kMetre = 0.4;  // metres in a length of the true world

inline double truth_between(const World& world, int32_t i, int32_t j) {
  return (world.truth(j).t - world.truth(i).t).norm();
}

inline unisim_distance distance(int32_t i, int32_t j, double metres, double relative_sigma) {
  unisim_distance d = {};
  d.struct_size = sizeof d;
  d.i = i;
  d.j = j;
  d.source = UNISIM_METRIC_ODOMETRY;
  d.metres = metres;
  d.sigma = relative_sigma * metres;
  return d;
}

inline unisim_status add(Host& host, const unisim_distance& d) {
  return unisim_add_distance(host, &d);
}

/// What an odometer says.
struct Odometer {
  double sigma = 0.02;  ///< that is declared
  double noise = 0.0;   ///< that is there
  double slips = 0.0;   ///< share of distances that are 40 % too long
  int32_t step = 4;     ///< keyframes between the ends
  std::mt19937 random{7};

  void feed(Host& host, const World& world, int32_t newest) {
    if (newest % step != 0 || newest < step) return;
    const double error = std::normal_distribution<double>(0.0, 1.0)(random) * noise;
    const double share = std::uniform_real_distribution<double>(0.0, 1.0)(random);
    const double slip = share < slips ? 1.4 : 1.0;
    const double metres = kMetre * truth_between(world, newest - step, newest);
    REQUIRE(add(host, distance(newest - step, newest, metres * std::exp(error) * slip, sigma)) ==
            UNISIM_OK);
  }
};

inline void walk(Host& host, World& world, Odometer& odometer, int32_t count) {
  for (int32_t k = 0; k < count; ++k) {
    feed(host, world, 1);
    odometer.feed(host, world, host.info().keyframes - 1);
  }
  host.optimize();
}

inline unisim_scale scale_of(Host& host, int32_t segment = 0) {
  unisim_scale scale = {};
  scale.struct_size = sizeof scale;
  REQUIRE(unisim_get_scale(host, segment, &scale) == UNISIM_OK);
  return scale;
}

/// Scale of the Sim(3) that lays kept positions on the truth in metres, by their spread.
inline double metres_per_unit_in_truth(const Host& host, const World& world) {
  const int32_t first = host.info().first_keyframe;
  const int32_t last = host.info().keyframes - 1;
  Vec3 mean = Vec3::Zero();
  Vec3 true_mean = Vec3::Zero();
  const int32_t count = last - first + 1;
  for (int32_t id = first; id <= last; ++id) {
    mean += from_c(host.pose(id).T_world_kf).t / count;
    true_mean += world.truth(id).t / count;
  }
  double spread = 0.0;
  double true_spread = 0.0;
  for (int32_t id = first; id <= last; ++id) {
    spread += (from_c(host.pose(id).T_world_kf).t - mean).squaredNorm();
    true_spread += (world.truth(id).t - true_mean).squaredNorm();
  }
  return kMetre * std::sqrt(true_spread / spread);
}

inline unisim_status ask(Host& host, int32_t segment) {
  unisim_scale scale = {};
  scale.struct_size = sizeof scale;
  return unisim_get_scale(host, segment, &scale);
}

}  // namespace unisim::test
