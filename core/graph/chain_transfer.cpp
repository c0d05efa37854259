// SPDX-License-Identifier: MIT
// Chain links moved from a node to another it has become rigid with, and fused.
#include "core/graph/chain_transfer.hpp"

#include "core/base/positive_definite.hpp"

namespace unisim {
namespace {

Mat7 symmetric(const Mat7& M) { return 0.5 * (M + M.transpose()); }

}  // namespace

// e = log(Z^-1 S_b^-1 S_c): a move d of b turns it by Ad(Z^-1) d.
ChainLink move_first_end(const ChainLink& link, const Sim3& T_a_b, const Mat7& covariance) {
  const Mat7 Ad = sim3_adjoint(link.Z_a_b.inverse());
  const Mat7 grown = inverse_of_positive(link.Lambda) + Ad * covariance * Ad.transpose();
  return {T_a_b * link.Z_a_b, inverse_of_positive(symmetric(grown))};
}

// S_b = S_a T_a_b makes e_b = Ad(T_a_b^-1) e_a.
ChainLink move_second_end(const ChainLink& link, const Sim3& T_a_b, const Mat7& covariance) {
  const Sim3 T_b_a = T_a_b.inverse();
  const Mat7 Ad = sim3_adjoint(T_b_a);
  const Mat7 Lambda = inverse_of_positive(inverse_of_positive(link.Lambda) + covariance);
  return {link.Z_a_b * T_b_a, symmetric(Ad.transpose() * Lambda * Ad)};
}

ChainLink fuse(const ChainLink& one, const ChainLink& other) {
  const Mat7 Lambda = one.Lambda + other.Lambda;
  const Vec7 apart = sim3_log(between(one.Z_a_b, other.Z_a_b));
  const Vec7 step = solve_positive(Lambda, other.Lambda * apart);
  return {retract(one.Z_a_b, step), Lambda};
}

double disagreement_squared(const ChainLink& one, const ChainLink& other) {
  const Vec7 apart = sim3_log(between(one.Z_a_b, other.Z_a_b));
  const Mat7 covariance = inverse_of_positive(one.Lambda) + inverse_of_positive(other.Lambda);
  return apart.dot(solve_positive(covariance, apart));
}

}  // namespace unisim
