// SPDX-License-Identifier: MIT
// Metric scale: distances and units in, metres per unit out.
#include <cmath>

#include "tests/capi/world.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/snapshot_bytes.hpp"

using namespace unisim;
using namespace unisim::test;

namespace {

constexpr double kMetre = 0.4;  // metres in a length of the true world

double truth_between(const World& world, int32_t i, int32_t j) {
  return (world.truth(j).t - world.truth(i).t).norm();
}

unisim_distance distance(int32_t i, int32_t j, double metres, double relative_sigma) {
  unisim_distance d = {};
  d.struct_size = sizeof d;
  d.i = i;
  d.j = j;
  d.source = UNISIM_METRIC_ODOMETRY;
  d.metres = metres;
  d.sigma = relative_sigma * metres;
  return d;
}

unisim_status add(Host& host, const unisim_distance& d) { return unisim_add_distance(host, &d); }

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

void walk(Host& host, World& world, Odometer& odometer, int32_t count) {
  for (int32_t k = 0; k < count; ++k) {
    feed(host, world, 1);
    odometer.feed(host, world, host.info().keyframes - 1);
  }
  host.optimize();
}

unisim_scale scale_of(Host& host, int32_t segment = 0) {
  unisim_scale scale = {};
  scale.struct_size = sizeof scale;
  REQUIRE(unisim_get_scale(host, segment, &scale) == UNISIM_OK);
  return scale;
}

/// Scale of the Sim(3) that lays kept positions on the truth in metres, by their spread.
double metres_per_unit_in_truth(const Host& host, const World& world) {
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

unisim_status ask(Host& host, int32_t segment) {
  unisim_scale scale = {};
  scale.struct_size = sizeof scale;
  return unisim_get_scale(host, segment, &scale);
}

}  // namespace

TEST_CASE("a session that was told no length is relative") {
  World world(40, 3U);
  Host host(small_windows(2));
  feed(host, world, 30);
  CHECK(ask(host, 0) == UNISIM_ERR_NOT_READY);
}

TEST_CASE("exact distances give the exact scale, in a batch and behind a sliding window") {
  const int32_t window_submaps = GENERATE(0, 2);
  World world(120, 3U);
  unisim_config config = small_windows(window_submaps);
  if (window_submaps > 0) config.skeleton_capacity = 8;
  Host host(config);
  Odometer odometer;
  walk(host, world, odometer, 110);
  const unisim_scale scale = scale_of(host);
  CHECK(scale.metres_per_unit == Approx(metres_per_unit_in_truth(host, world)).epsilon(1e-6));
  CHECK(scale.refused == 0);
  CHECK(scale.lost == 0);
  CHECK(scale.taken + scale.waiting == 27);
  CHECK(scale.sigma > 0.0);
  CHECK(scale.sigma < 0.01);
}

TEST_CASE("distances change no pose of a map that agrees with them") {
  World world(60, 3U);
  World same(60, 3U);
  Host host(small_windows(2));
  Host without(small_windows(2));
  Odometer odometer;
  walk(host, world, odometer, 50);
  feed(without, same, 50);
  without.optimize();
  for (int32_t id = 0; id < 50; ++id) {
    const Sim3 a = from_c(host.pose(id).T_world_kf);
    const Sim3 b = from_c(without.pose(id).T_world_kf);
    CHECK((a.t - b.t).norm() < 1e-5);
  }
}

TEST_CASE("one known distance across many windows is enough") {
  World world(120, 3U);
  Host host(small_windows(2));
  feed(host, world, 100);
  const double metres = kMetre * truth_between(world, 10, 60);
  REQUIRE(add(host, distance(60, 10, metres, 0.01)) == UNISIM_OK);
  host.optimize();
  const unisim_scale scale = scale_of(host);
  CHECK(scale.metres_per_unit == Approx(metres_per_unit_in_truth(host, world)).epsilon(1e-6));
  CHECK(scale.sigma == Approx(std::sqrt(0.01 * 0.01 + 0.005 * 0.005)).epsilon(0.05));
  CHECK(scale.taken == 1);
}

TEST_CASE("a distance waits for the window over its keyframes") {
  World world(40, 3U);
  Host host(small_windows(2));
  feed(host, world, 7);
  REQUIRE(add(host, distance(0, 5, kMetre * truth_between(world, 0, 5), 0.01)) == UNISIM_OK);
  host.optimize();
  CHECK(ask(host, 0) == UNISIM_ERR_NOT_READY);
  feed(host, world, 3);
  CHECK(scale_of(host).taken == 1);
}

TEST_CASE("slips of the wheels do not count") {
  for (uint32_t seed = 1; seed <= 5; ++seed) {
    World world(220, seed);
    Host host(small_windows(2));
    Odometer odometer;
    odometer.noise = 0.02;
    odometer.slips = 0.1;
    odometer.random.seed(seed);
    walk(host, world, odometer, 210);
    const unisim_scale scale = scale_of(host);
    const double error = std::log(scale.metres_per_unit / metres_per_unit_in_truth(host, world));
    CAPTURE(seed, error, scale.sigma, scale.refused);
    CHECK(std::abs(error) < 0.02);
    CHECK(scale.refused >= 1);
  }
}

TEST_CASE("the error of the scale is what its standard deviation says") {
  constexpr int kSeeds = 20;
  double chi2 = 0.0;
  int beyond = 0;
  for (uint32_t seed = 1; seed <= kSeeds; ++seed) {
    Noise noise;
    noise.rotation = 0.001;
    noise.translation = 0.001;
    noise.depth = 0.005;
    World world(220, seed, noise);
    Host host(small_windows(2));
    Odometer odometer;
    odometer.noise = 0.02;
    odometer.random.seed(100 + seed);
    walk(host, world, odometer, 210);
    const unisim_scale scale = scale_of(host);
    const double error = std::log(scale.metres_per_unit / metres_per_unit_in_truth(host, world));
    const double whitened = error / scale.sigma;
    CAPTURE(seed, error, scale.sigma);
    CHECK(scale.sigma < 0.01);
    chi2 += whitened * whitened;
    beyond += std::abs(whitened) > 3.0 ? 1 : 0;
  }
  CHECK(beyond <= 1);
  // Chi-square of 20: within 7.4 and 40 in 99 of 100 cases.
  CHECK(chi2 > 7.4);
  CHECK(chi2 < 40.0);
}

TEST_CASE("what all measurements have in common stays in the standard deviation") {
  World world(120, 3U);
  Host host(small_windows(2));
  for (int32_t k = 0; k < 100; ++k) {
    feed(host, world, 1);
    if (k % 4 != 0 || k == 0) continue;
    unisim_distance d = distance(k - 4, k, kMetre * truth_between(world, k - 4, k), 0.02);
    d.common_sigma = 0.03;
    REQUIRE(add(host, d) == UNISIM_OK);
  }
  host.optimize();
  CHECK(scale_of(host).sigma >= 0.03);
  CHECK(scale_of(host).sigma < 0.035);
}

TEST_CASE("units of submaps in metres give the scale too, and follow a new measurement") {
  World world(40, 3U);
  Host host(small_windows(2));
  host.feed(world, 7);
  const Views views = world.views(ids(0, 8));
  host.add_keyframe();
  REQUIRE(host.add_pair(world.pair(6)) == UNISIM_OK);
  const int32_t submap = host.add_submap(views);
  const double length = (from_c(views.T_submap_kf[7]).t - from_c(views.T_submap_kf[0]).t).norm();
  unisim_submap_unit unit = {};
  unit.struct_size = sizeof unit;
  unit.submap_id = submap;
  unit.source = UNISIM_METRIC_MODEL;
  unit.metres = kMetre * truth_between(world, 0, 7) / length;
  unit.sigma = 0.1;
  REQUIRE(unisim_add_submap_unit(host, &unit) == UNISIM_OK);
  host.optimize();
  const double expected = metres_per_unit_in_truth(host, world);
  CHECK(scale_of(host).metres_per_unit == Approx(expected).epsilon(1e-6));
  CHECK(scale_of(host).sigma == Approx(0.1).epsilon(0.02));

  // The window again, in a unit twice as long: half the numbers.
  std::vector<unisim_sim3> poses = views.T_submap_kf;
  for (unisim_sim3& T : poses) {
    for (double& t : T.t) t *= 0.5;
  }
  const std::vector<double> ratios(8, std::log(0.5));
  unisim_submap_update update = {};
  update.struct_size = sizeof update;
  update.submap_id = submap;
  update.count = 8;
  update.T_submap_kf = poses.data();
  update.log_depth_ratio = ratios.data();
  REQUIRE(unisim_update_submap(host, &update) == UNISIM_OK);
  host.optimize();
  CHECK(scale_of(host).metres_per_unit == Approx(expected).epsilon(1e-6));
}

TEST_CASE("scale that drifts is corrected by distances along the way") {
  const bool told = GENERATE(false, true);
  World world(220, 3U);
  Host host(small_windows(2));
  Odometer odometer;
  odometer.sigma = 0.005;
  for (int32_t k = 0; k < 210; ++k) {
    const int32_t id = host.add_keyframe();
    if (id > 0) {
      Pair pair = world.pair(id - 1);
      // The second view of each pair seems 0.1 % nearer than it is.
      for (float& pixel : pair.depth_j.pixels()) pixel *= 0.999F;
      REQUIRE(host.add_pair(pair) == UNISIM_OK);
    }
    const unisim_request request = host.next(UNISIM_REQUEST_WINDOW);
    if (request.kind != 0) {
      Views views = world.views(
          std::vector<int32_t>(request.keyframe_ids, request.keyframe_ids + request.count));
      for (size_t view = 0; view < views.depth.size(); ++view) {
        const auto factor = static_cast<float>(std::pow(0.999, static_cast<double>(view)));
        for (float& pixel : views.depth[view].pixels()) pixel *= factor;
        views.maps[view] = views.depth[view].map();
      }
      REQUIRE(host.add_submap(views) >= 0);
      host.optimize();
    }
    if (told) odometer.feed(host, world, id);
  }
  host.optimize();
  const auto step = [&](int32_t i) {
    const double length =
        (from_c(host.pose(i + 8).T_world_kf).t - from_c(host.pose(i).T_world_kf).t).norm();
    return length / truth_between(world, i, i + 8);
  };
  const double drift = std::abs(std::log(step(190) / step(4)));
  if (told) {
    CHECK(drift < 0.05);
  } else {
    CHECK(drift > 0.15);
  }
}

TEST_CASE("each segment has its own scale, and they have one when they join") {
  World world(120, 3U);
  unisim_config config = small_windows(2);
  config.lost_after = 1;
  Host host(config);
  Odometer odometer;
  for (int32_t k = 0; k < 40; ++k) {
    feed(host, world, 1);
    odometer.feed(host, world, k);
  }
  host.add_keyframe();
  REQUIRE(host.reject_pair() == UNISIM_OK);
  for (int32_t k = 41; k < 90; ++k) {
    REQUIRE(host.add_keyframe() == k);
    REQUIRE(host.add_pair(world.pair(k - 1)) == UNISIM_OK);
    const unisim_request window = host.next(UNISIM_REQUEST_WINDOW);
    if (k >= 48) odometer.feed(host, world, k);
    if (window.kind == 0) continue;
    const std::vector<int32_t> seen(window.keyframe_ids, window.keyframe_ids + window.count);
    if (seen[0] < 40) {  // over the break: nobody saw it
      REQUIRE(unisim_reject_request(host, &window) == UNISIM_OK);
    } else {
      REQUIRE(host.add_submap(world.views(seen)) >= 0);
      host.optimize();
    }
  }
  host.optimize();
  REQUIRE(host.info().segments == 2);
  const int32_t second = host.pose(80).segment;
  const auto expect_scale = [&](int32_t segment, int32_t i, int32_t j) {
    const double length =
        (from_c(host.pose(j).T_world_kf).t - from_c(host.pose(i).T_world_kf).t).norm();
    CHECK(scale_of(host, segment).metres_per_unit ==
          Approx(kMetre * truth_between(world, i, j) / length).epsilon(1e-5));
  };
  expect_scale(0, 5, 25);
  expect_scale(second, 60, 80);
  REQUIRE(host.add_loop(world.views(both(20, 70))) >= 0);
  host.optimize();
  REQUIRE(host.info().segments == 1);
  CHECK(ask(host, second) == UNISIM_ERR_NOT_READY);
  expect_scale(0, 5, 80);
}

TEST_CASE("distances and units are checked") {
  World world(40, 3U);
  Host host(small_windows(2));
  feed(host, world, 20);
  const unisim_distance good = distance(3, 9, 1.0, 0.01);
  const auto expect = [&](unisim_status status, const unisim_distance& d) {
    CHECK(add(host, d) == status);
  };
  unisim_distance d = good;
  expect(UNISIM_OK, good);
  d.j = 3;
  expect(UNISIM_ERR_INVALID_ARGUMENT, d);
  d.j = 20;
  expect(UNISIM_ERR_INVALID_ARGUMENT, d);
  d.j = -1;
  expect(UNISIM_ERR_INVALID_ARGUMENT, d);
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    d = good;
    d.metres = bad;
    expect(UNISIM_ERR_INVALID_ARGUMENT, d);
    d = good;
    d.sigma = bad;
    expect(UNISIM_ERR_INVALID_ARGUMENT, d);
  }
  d = good;
  d.sigma = 1.1;
  expect(UNISIM_ERR_INVALID_ARGUMENT, d);
  d = good;
  d.common_sigma = -0.1;
  expect(UNISIM_ERR_INVALID_ARGUMENT, d);
  d = good;
  d.source = 4;
  expect(UNISIM_ERR_INVALID_ARGUMENT, d);
  d = good;
  d.struct_size = 8;
  expect(UNISIM_ERR_ABI_MISMATCH, d);
  CHECK(unisim_add_distance(host, nullptr) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_add_distance(nullptr, &good) == UNISIM_ERR_INVALID_ARGUMENT);

  unisim_submap_unit unit = {};
  unit.struct_size = sizeof unit;
  unit.metres = 1.0;
  unit.sigma = 0.1;
  CHECK(unisim_add_submap_unit(host, &unit) == UNISIM_OK);
  unit.submap_id = 100;
  CHECK(unisim_add_submap_unit(host, &unit) == UNISIM_ERR_INVALID_ARGUMENT);
  unit.submap_id = 0;
  unit.sigma = 0.0;
  CHECK(unisim_add_submap_unit(host, &unit) == UNISIM_ERR_INVALID_ARGUMENT);
  unit.sigma = 0.1;
  unit.metres = -1.0;
  CHECK(unisim_add_submap_unit(host, &unit) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_add_submap_unit(host, nullptr) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_get_scale(host, 0, nullptr) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(ask(host, -1) == UNISIM_ERR_INVALID_ARGUMENT);
}

TEST_CASE("a distance to a keyframe that is no longer kept is said to be late") {
  World world(400, 3U);
  unisim_config config = small_windows(2);
  config.max_keyframes = 88;
  Host host(config);
  feed(host, world, 200);
  CHECK(add(host, distance(0, 190, 1.0, 0.01)) == UNISIM_ERR_RETIRED);
}

TEST_CASE("more distances than the session keeps: the oldest makes room") {
  World world(40, 3U);
  Host host(small_windows(2));
  feed(host, world, 3);
  for (int32_t k = 0; k < 300; ++k) {
    REQUIRE(add(host, distance(0, 2, kMetre * truth_between(world, 0, 2), 0.01)) == UNISIM_OK);
  }
  feed(host, world, 10);
  const unisim_scale scale = scale_of(host);
  CHECK(scale.lost == 44);
  CHECK(scale.taken == 256);
}

TEST_CASE("reset forgets what a metre was") {
  World world(60, 3U);
  Host host(small_windows(2));
  Odometer odometer;
  walk(host, world, odometer, 40);
  REQUIRE(unisim_session_reset(host) == UNISIM_OK);
  CHECK(ask(host, 0) == UNISIM_ERR_NOT_READY);
}

TEST_CASE("a saved map keeps what is known of its metre, and distances that wait") {
  const int32_t window_submaps = GENERATE(0, 2);
  World world(160, 3U);
  unisim_config config = small_windows(window_submaps);
  Host host(config);
  Odometer odometer;
  walk(host, world, odometer, 91);
  REQUIRE(scale_of(host).waiting > 0);
  SnapshotBytes snapshot = save(host);
  Host other(config);
  REQUIRE(load(other, &snapshot) == UNISIM_OK);
  other.go_on(host.info().keyframes);
  CHECK(scale_of(other).metres_per_unit == scale_of(host).metres_per_unit);
  CHECK(scale_of(other).sigma == scale_of(host).sigma);
  World again = world;
  Odometer same = odometer;
  walk(host, world, odometer, 40);
  walk(other, again, same, 40);
  CHECK(scale_of(other).metres_per_unit == scale_of(host).metres_per_unit);
  CHECK(scale_of(other).sigma == scale_of(host).sigma);
  CHECK(scale_of(other).taken == scale_of(host).taken);
}

TEST_CASE("a damaged map with a metre is refused or harmless") {
  World world(160, 3U);
  unisim_config config = small_windows(2);
  Host host(config);
  Odometer odometer;
  walk(host, world, odometer, 60);
  const SnapshotBytes good = save(host);
  for (size_t at = 0; at < good.bytes.size(); at += 97) {
    SnapshotBytes bad = good;
    bad.bytes[at] ^= 0x40U;
    Host other(config);
    CHECK(load(other, &bad) != UNISIM_OK);
  }
}
