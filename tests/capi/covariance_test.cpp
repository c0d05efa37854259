// SPDX-License-Identifier: MIT
// The joint covariance of poses, and how what the predictor says of itself enters it.
#include <vector>

#include "tests/capi/world.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::test;

namespace {

using Joint = std::vector<std::vector<double>>;

/// Column by column; 7 rows a keyframe.
Joint joint_covariance(unisim_session* session, int32_t first, int32_t count) {
  const auto size = static_cast<size_t>(7 * count);
  Joint columns;
  std::vector<double> weights(size);
  for (size_t k = 0; k < size; ++k) {
    weights.assign(size, 0.0);
    weights[k] = 1.0;
    columns.emplace_back(size);
    REQUIRE(unisim_multiply_covariance(session, first, count, weights.data(),
                                       columns.back().data()) == UNISIM_OK);
  }
  return columns;
}

/// Its blocks on the diagonal are what each keyframe has by itself, and it equals its transpose.
void check_joint(unisim_session* session, int32_t first, int32_t count) {
  const Joint joint = joint_covariance(session, first, count);
  for (int32_t i = 0; i < count; ++i) {
    double alone[49];
    REQUIRE(unisim_get_covariance(session, first + i, alone) == UNISIM_OK);
    for (size_t k = 0; k < 49; ++k) {
      const size_t at = static_cast<size_t>(7 * i);
      CHECK(joint[at + k / 7][at + k % 7] == Approx(alone[k]).margin(1e-12));
    }
  }
  for (size_t a = 0; a < joint.size(); ++a) {
    for (size_t b = 0; b < a; ++b) CHECK(joint[a][b] == Approx(joint[b][a]).margin(1e-12));
  }
}

double spread(unisim_session* session, int32_t keyframe) {
  double covariance[49];
  REQUIRE(unisim_get_covariance(session, keyframe, covariance) == UNISIM_OK);
  return covariance[0] + covariance[8] + covariance[16];
}

/// Windows that agree to the last digit and say how sure they are.
double spread_of_exact_run(double center_sigma, double factor) {
  World world(26, 12U);
  unisim_config config = small_windows(0);
  config.sigma_factor = factor;
  Host host(config);
  feed_pairs(host, world, 26);
  for (int32_t first = 0; first <= 18; first += 6) {
    Views views = world.views(ids(first, 8));
    views.center_sigma = center_sigma;
    REQUIRE(host.add_submap(views) >= 0);
  }
  host.optimize();
  return spread(host, 25);
}

}  // namespace

TEST_CASE("products give the joint covariance, of a batch and behind a window") {
  World world(60, 12U, kNoise);
  SECTION("batch") {
    Host host(small_windows(0));
    feed(host, world, 20);
    host.optimize();
    check_joint(host, 0, 20);
    check_joint(host, 11, 5);
  }
  SECTION("window") {
    Host host(small_windows(2));
    feed(host, world, 60);
    host.optimize();
    check_joint(host, 2, 8);
    check_joint(host, 48, 12);
  }
}

TEST_CASE("a product needs keyframes that are there and a map that is solved") {
  World world(60, 12U, kNoise);
  Host host(small_windows(0));
  feed(host, world, 20);
  host.optimize();
  std::vector<double> weights(7 * 20, 1.0);
  std::vector<double> products(7 * 20, -3.0);
  const auto product = [&](int32_t first, int32_t count) {
    return unisim_multiply_covariance(host, first, count, weights.data(), products.data());
  };
  CHECK(product(-1, 3) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(product(20, 1) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(product(0, 21) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(product(0, 0) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(product(5, 2147483647) == UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(unisim_multiply_covariance(host, 0, 20, nullptr, products.data()) ==
        UNISIM_ERR_INVALID_ARGUMENT);
  CHECK(products[0] == -3.0);
  REQUIRE(product(0, 20) == UNISIM_OK);
  for (size_t k = 0; k < 7; ++k) CHECK(products[k] == 0.0);
  CHECK(products[7 * 19] != 0.0);
  feed(host, world, 1);
  CHECK(product(0, 20) == UNISIM_ERR_NOT_READY);
}

TEST_CASE("windows that agree are no surer than they say they are") {
  const double told = spread_of_exact_run(0.0005, 3.0);
  CHECK(spread_of_exact_run(0.0005, 3.0) == told);
  CHECK(spread_of_exact_run(0.001, 3.0) == Approx(4.0 * told).epsilon(1e-6));
  CHECK(spread_of_exact_run(0.0005, 1.0) == Approx(told / 9.0).epsilon(1e-6));
  CHECK(spread_of_exact_run(0.0005, 0.0) < 1e-3 * told);
  CHECK(spread_of_exact_run(0.0, 3.0) < 1e-3 * told);
}

TEST_CASE("keyframes that are rigid in a submap still have errors of their own") {
  const auto between_neighbours = [](int32_t window_submaps) {
    World world(60, 12U, kNoise);
    Host host(small_windows(window_submaps));
    feed(host, world, 60);
    host.optimize();
    const Joint joint = joint_covariance(host, 20, 2);
    double variance = 0.0;
    for (size_t k = 0; k < 3; ++k) {
      variance += joint[k][k] + joint[7 + k][7 + k] - 2.0 * joint[k][7 + k];
    }
    return variance;
  };
  CHECK(between_neighbours(2) > 0.5 * between_neighbours(0));
}
