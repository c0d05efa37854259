// SPDX-License-Identifier: MIT
// Positive definite 7x7 matrices, against Eigen's own factor.
#include "core/base/positive_definite.hpp"

#include <Eigen/Cholesky>
#include <limits>

#include "tests/support/catch.hpp"
#include "tests/unit/core_support.hpp"

using namespace unisim;
using unisim_test::difference;

namespace {

Mat7 positive(unisim_test::Random& random) {
  Mat7 M;
  for (int k = 0; k < M.size(); ++k) M.data()[k] = random.uniform(-1.0, 1.0);
  return M * M.transpose() + 0.1 * Mat7::Identity();
}

}  // namespace

TEST_CASE("inverse and solution are those of Eigen") {
  unisim_test::Random random(11);
  for (int run = 0; run < 50; ++run) {
    const Mat7 A = positive(random);
    const Vec7 b = positive(random).col(0);
    const Mat7 inverse = inverse_of_positive(A);
    CHECK(is_positive_definite(A));
    CHECK(difference(inverse, A.llt().solve(Mat7::Identity())) < 1e-12);
    CHECK(difference(inverse, inverse.transpose()) == 0.0);
    CHECK(difference(solve_positive(A, b), A.llt().solve(b)) < 1e-12);
  }
}

TEST_CASE("the upper triangle is not read") {
  unisim_test::Random random(12);
  const Mat7 A = positive(random);
  Mat7 lower = A;
  lower(0, 6) = 1e9;
  CHECK(difference(inverse_of_positive(lower), inverse_of_positive(A)) == 0.0);
}

TEST_CASE("a matrix that is not positive definite has no inverse") {
  unisim_test::Random random(13);
  const double wrong = GENERATE(0.0, -1.0, std::numeric_limits<double>::infinity(),
                                std::numeric_limits<double>::quiet_NaN());
  for (int k = 0; k < kTangentDim; ++k) {
    Mat7 A = positive(random);
    A(k, k) = wrong;
    CHECK_FALSE(is_positive_definite(A));
    CHECK(inverse_of_positive(A).array().isNaN().all());
    CHECK(solve_positive(A, Vec7::Zero()).array().isNaN().all());
  }
}
