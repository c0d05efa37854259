// SPDX-License-Identifier: MIT
// Simulated walks through a session: errors as published for the method, times by length.
#include "tools/bench/walk/walk_run.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/support/catch.hpp"

using namespace unisim;
using namespace unisim::bench;

namespace {

constexpr int kSeeds = 6;

// Mean error over seeds.
double mean_ate(WalkSettings settings) {
  double sum = 0.0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    settings.seed = static_cast<uint64_t>(seed);
    settings.batch = false;
    sum += run_walk(settings, {}).ate_m;
  }
  return sum / kSeeds;
}

WalkSettings scan() {
  WalkSettings settings;
  settings.world = simulator::WorldKind::kScan;
  settings.keyframes = 200;
  return settings;
}

}  // namespace

TEST_CASE("pairs alone drift, submaps hold, loops hold better") {
  WalkSettings settings = scan();
  const double full = mean_ate(settings);
  settings.loops = false;
  const double no_loops = mean_ate(settings);
  settings.submaps = false;
  const double pairs = mean_ate(settings);
  // Means over many seeds are 0.022, 0.029 and 0.21 m, with a spread of half their size by seed.
  CHECK(full < 0.03);
  CHECK(no_loops < 0.04);
  CHECK(full < no_loops);
  CHECK(pairs > 3.0 * no_loops);
  CHECK(pairs < 0.4);
}

TEST_CASE("loops close the rounds of a walk, with false ones among them too") {
  WalkSettings settings;
  settings.keyframes = 600;
  settings.seed = 1;
  settings.batch = false;
  const WalkResult closed = run_walk(settings, {});
  settings.false_loops = 0.1;
  const WalkResult deceived = run_walk(settings, {});
  settings.loops = false;
  const WalkResult open = run_walk(settings, {});
  CHECK(closed.loops > 10);
  CHECK(closed.ate_m < 0.08);
  CHECK(open.ate_m > 0.15);
  CHECK(deceived.loops > closed.loops);
  CHECK(deceived.ate_m < 1.25 * closed.ate_m);
}

TEST_CASE("a sliding window with its skeleton is about as right as the full batch") {
  WalkSettings settings;
  settings.keyframes = 600;
  settings.skeleton_capacity = 0;
  const WalkResult unlimited = run_walk(settings, {});
  CHECK(unlimited.ate_over_batch > 0.0);
  CHECK(unlimited.ate_over_batch < 1.3);
  settings.skeleton_capacity = 16;
  const WalkResult merged = run_walk(settings, {});
  CHECK(merged.ate_m != unlimited.ate_m);
  CHECK(merged.ate_m < 0.1);
}

TEST_CASE("a walk longer than what stays readable is known from what was streamed out") {
  WalkSettings settings;
  settings.keyframes = 600;
  settings.batch = false;
  const WalkResult whole = run_walk(settings, {});
  settings.readable = 590;
  const WalkResult streamed = run_walk(settings, {});
  CHECK(whole.loops_out_of_reach == 0);
  CHECK(streamed.loops_out_of_reach == 0);
  CHECK(std::abs(streamed.ate_m - whole.ate_m) < 1e-9);
  settings.readable = 300;
  const WalkResult forgetful = run_walk(settings, {});
  CHECK(forgetful.loops_out_of_reach > 0);
  CHECK(forgetful.arena_bytes < whole.arena_bytes);
  settings.keyframes = 900;
  CHECK(run_walk(settings, {}).arena_bytes == forgetful.arena_bytes);
}

TEST_CASE("the full batch is its own measure, and comparing can be left out") {
  WalkSettings settings = scan();
  settings.batch = false;
  CHECK(run_walk(settings, {}).ate_over_batch == 0.0);
  settings.window_submaps = 0;
  CHECK(run_walk(settings, {}).ate_over_batch == 1.0);
}

TEST_CASE("the same walk gives the same poses") {
  const WalkResult one = run_walk(scan(), {});
  const WalkResult two = run_walk(scan(), {});
  CHECK(one.ate_m == two.ate_m);
  CHECK(one.live_ate_m == two.live_ate_m);
  CHECK(one.keyframes == 200);
  CHECK(one.update_ms.size() == static_cast<size_t>(one.submaps));
  CHECK(one.loop_update_ms.size() == static_cast<size_t>(one.loops));
}

TEST_CASE("times and memory by length of the walk") {
  for (const int32_t keyframes : {100, 500, 2000}) {
#ifndef NDEBUG
    if (keyframes > 500) continue;  // minutes without optimisation
#endif
    WalkSettings settings;
    settings.keyframes = keyframes;
    settings.batch = false;
    WalkResult result = run_walk(settings, {});
    REQUIRE_FALSE(result.update_ms.empty());
    std::sort(result.update_ms.begin(), result.update_ms.end());
    std::printf(
        "%5d keyframes: %3d submaps, %3d loops, update median %.2f ms, max %.2f ms, %zu bytes\n",
        keyframes, result.submaps, result.loops, result.update_ms[result.update_ms.size() / 2],
        result.update_ms.back(), result.arena_bytes);
  }
}

TEST_CASE(
    "what is left out is missed: bridges most, and without views to submaps pairs are alone") {
  WalkSettings settings = scan();
  const double full = mean_ate(settings);
  const auto without = [&](uint32_t factors) {
    WalkSettings less = settings;
    less.disabled_factors = factors;
    return mean_ate(less);
  };
  CHECK(without(UNISIM_FACTOR_BRIDGE) > 1.5 * full);
  WalkSettings pairs = settings;
  pairs.submaps = pairs.loops = false;
  const double alone = mean_ate(pairs);
  // No pose is held to a submap: what is optimised is the chain of pairs.
  CHECK(without(UNISIM_FACTOR_BRIDGE | UNISIM_FACTOR_SCALE_ANCHOR) == Approx(alone).epsilon(1e-3));
}

TEST_CASE("noise of the scale costs, noise of single depths hardly anything") {
  WalkSettings settings = scan();
  const double full = mean_ate(settings);
  WalkSettings scale = settings;
  scale.scale_noise = 0.15;
  CHECK(mean_ate(scale) > 1.2 * full);
  WalkSettings depth = settings;
  depth.depth_noise = 0.2;
  depth.holes = 0.1;
  CHECK(mean_ate(depth) < 1.2 * full);
}
