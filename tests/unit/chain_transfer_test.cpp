// SPDX-License-Identifier: MIT
// Chain links that change a node, and the mean of two.
#include "core/graph/chain_transfer.hpp"

#include "core/base/positive_definite.hpp"
#include "tests/support/catch.hpp"
#include "tests/unit/core_support.hpp"

using namespace unisim;
using unisim_test::difference;

namespace {

Mat7 information(unisim_test::Random& random) {
  Mat7 M;
  for (int k = 0; k < M.size(); ++k) M.data()[k] = random.uniform(-1.0, 1.0);
  return 10.0 * M * M.transpose() + Mat7::Identity();
}

double cost(const Sim3& A, const Sim3& B, const ChainLink& link) {
  const Vec7 e = chain_residual(A, B, link.Z_a_b);
  return e.dot(link.Lambda * e);
}

}  // namespace

TEST_CASE("a link moved between rigid nodes costs the same") {
  unisim_test::Random random(4);
  const Sim3 A = random.pose(2.0, 1.0, 0.3);
  const Sim3 T_a_b = random.pose(1.0, 1.0, 0.3);
  const Sim3 B = A * T_a_b;
  const Sim3 C = random.pose(2.0, 1.0, 0.3);
  const ChainLink from_b = {random.pose(1.0, 1.0, 0.3), information(random)};
  const ChainLink to_b = {random.pose(1.0, 1.0, 0.3), information(random)};
  const Mat7 none = Mat7::Zero();
  CHECK(cost(A, C, move_first_end(from_b, T_a_b, none)) == Approx(cost(B, C, from_b)));
  CHECK(cost(C, A, move_second_end(to_b, T_a_b, none)) == Approx(cost(C, B, to_b)));
}

TEST_CASE("a link moved over a loose joint says less") {
  unisim_test::Random random(4);
  const Sim3 T_a_b = random.pose(1.0, 1.0, 0.3);
  const ChainLink link = {random.pose(1.0, 1.0, 0.3), information(random)};
  const Mat7 joint = 0.1 * Mat7::Identity();
  const Mat7 Ad = sim3_adjoint(link.Z_a_b.inverse());
  const Mat7 expected = inverse_of_positive(link.Lambda) + 0.1 * Ad * Ad.transpose();
  const ChainLink moved = move_first_end(link, T_a_b, joint);
  CHECK(difference(moved.Lambda * expected, Mat7::Identity()) < 1e-9);
  CHECK(valid_link(moved));
  CHECK(valid_link(move_second_end(link, T_a_b, joint)));
}

TEST_CASE("fused links have the sum of informations and lie between the two") {
  unisim_test::Random random(4);
  const ChainLink one = {random.pose(1.0, 1.0, 0.3), 3.0 * Mat7::Identity()};
  Vec7 apart = Vec7::Zero();
  apart(0) = 0.04;
  const ChainLink other = {retract(one.Z_a_b, apart), Mat7::Identity()};
  const ChainLink mean = fuse(one, other);
  CHECK(difference(mean.Lambda, 4.0 * Mat7::Identity()) < 1e-12);
  CHECK(difference(mean.Z_a_b, retract(one.Z_a_b, 0.25 * apart)) < 1e-12);
  CHECK(disagreement_squared(one, other) == Approx(0.04 * 0.04 * 0.75));
}
