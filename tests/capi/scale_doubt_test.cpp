// SPDX-License-Identifier: MIT
// Pairs whose scale is a guess: what the state says, how far it is believed, what settles it.
#include <cmath>
#include <limits>
#include <string>

#include "tests/capi/world.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::test;

namespace {

constexpr int32_t kKeyframes = 24;
constexpr int32_t kLater = 18;  // in a window that begins after the turn
constexpr int32_t kTurn = 9;    // keyframe after the pair in doubt
constexpr double kSigma = 0.5;

struct Walk {
  World world{40, 6U, kNoise};
  Host host{small_windows(0)};
  int32_t over = -1;  // the window over the pair
  Views measured;     // as it was handed in

  explicit Walk(double log_scale_sigma) {
    for (int32_t id = 0; id < kKeyframes; ++id) {
      host.add_keyframe();
      if (id == 0) continue;
      Pair pair = world.pair(id - 1);
      if (id == kTurn) pair.two_view.log_scale_sigma = log_scale_sigma;
      REQUIRE(host.add_pair(pair) == UNISIM_OK);
      while (host.next(UNISIM_REQUEST_WINDOW).kind != 0) {
        const unisim_request request = host.next(UNISIM_REQUEST_WINDOW);
        const int32_t* const first = request.keyframe_ids;
        const Views views = world.views({first, first + request.count});
        const int32_t submap = host.add_submap(views);
        REQUIRE(submap >= 0);
        if (views.ids.front() >= kTurn || views.ids.back() < kTurn) continue;
        over = submap;
        measured = views;
      }
    }
    host.optimize();
  }

  /// Standard deviation of the log scale of a keyframe.
  double scale_sigma(int32_t id) {
    double covariance[49];
    REQUIRE(unisim_get_covariance(host, id, covariance) == UNISIM_OK);
    return std::sqrt(covariance[48]);
  }

  void measure_again(int32_t scale_settled) {
    const std::vector<double> same(measured.ids.size(), 0.0);
    unisim_submap_update update = {};
    update.struct_size = sizeof update;
    update.submap_id = over;
    update.count = static_cast<int32_t>(measured.ids.size());
    update.scale_settled = scale_settled;
    update.T_submap_kf = measured.T_submap_kf.data();
    update.log_depth_ratio = same.data();
    REQUIRE(unisim_update_submap(host, &update) == UNISIM_OK);
    host.optimize();
  }
};

/// Pairs alone, the one that ends at kTurn with this doubt.
void feed_up_to_turn(Host& host, World& world, double log_scale_sigma) {
  feed_pairs(host, world, kTurn);
  host.add_keyframe();
  Pair pair = world.pair(kTurn - 1);
  pair.two_view.log_scale_sigma = log_scale_sigma;
  REQUIRE(host.add_pair(pair) == UNISIM_OK);
}

}  // namespace

TEST_CASE("a pair with a guessed scale is taken, and the state says so until the next one") {
  World world(40, 6U);
  Host host(small_windows(0));
  feed_up_to_turn(host, world, kSigma);
  CHECK(host.info().state == UNISIM_STATE_DEGRADED);
  CHECK(host.info().pairs_refused == 0);
  CHECK(host.info().lost_events == 0);
  CHECK(host.pose(kTurn).confidence == 1);
  CHECK(host.info().posed_keyframes == kTurn + 1);
  host.add_keyframe();
  REQUIRE(host.add_pair(world.pair(kTurn)) == UNISIM_OK);
  CHECK(host.info().state == UNISIM_STATE_TRACKING);
  CHECK(host.pose(kTurn).state == UNISIM_STATE_DEGRADED);
  CHECK(host.optimize().final_cost < 1e-10);
}

TEST_CASE("a scale that is hardly in doubt degrades nothing") {
  World world(40, 6U);
  Host host(small_windows(0));
  feed_up_to_turn(host, world, 0.05);
  CHECK(host.info().state == UNISIM_STATE_TRACKING);
}

TEST_CASE("behind a guessed scale the precision is lost, before it nothing is") {
  Walk sure(0.0);
  Walk doubtful(kSigma);
  CHECK(doubtful.scale_sigma(kTurn - 1) < 2 * sure.scale_sigma(kTurn - 1));
  CHECK(doubtful.scale_sigma(kTurn) > 20 * sure.scale_sigma(kTurn));
  CHECK(doubtful.scale_sigma(kLater) > 20 * sure.scale_sigma(kLater));
}

TEST_CASE("a window measured again settles the scale when it says so") {
  Walk walk(kSigma);
  const double before = walk.scale_sigma(kLater);
  SECTION("it does not") {
    walk.measure_again(0);
    CHECK(walk.scale_sigma(kLater) > 0.2 * before);
  }
  SECTION("it does") {
    walk.measure_again(1);
    CHECK(walk.scale_sigma(kLater) < 0.1 * before);
  }
}

TEST_CASE("a loop around a guessed scale settles it") {
  Walk walk(kSigma);
  const double before = walk.scale_sigma(kLater);
  REQUIRE(walk.host.add_loop(walk.world.views(both(4, 18))) >= 0);
  walk.host.optimize();
  CHECK(walk.scale_sigma(kLater) < 0.1 * before);
}

TEST_CASE("a standard deviation that is none is refused") {
  World world(40, 6U);
  Host host(small_windows(0));
  host.add_keyframe();
  host.add_keyframe();
  Pair pair = world.pair(0);
  for (const double wrong :
       {-0.1, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    pair.two_view.log_scale_sigma = wrong;
    CHECK(host.add_pair(pair) == UNISIM_ERR_INVALID_ARGUMENT);
  }
  pair.two_view.log_scale_sigma = 0.0;
  CHECK(host.add_pair(pair) == UNISIM_OK);
}
