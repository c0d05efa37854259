// SPDX-License-Identifier: MIT
// Robust kernels: values by hand and weight = rho'(u) / u.
#include "core/graph/robust_kernel.hpp"

#include <cmath>

#include "core/graph/geman_mcclure.hpp"
#include "core/graph/huber.hpp"
#include "tests/support/catch.hpp"

using namespace unisim;

TEST_CASE("Huber is quadratic up to delta and linear beyond") {
  CHECK(huber(0.25, 1.0).cost == Approx(0.125));
  CHECK(huber(0.25, 1.0).weight == 1.0);
  CHECK(huber(9.0, 1.0).cost == Approx(2.5));
  CHECK(huber(9.0, 1.0).weight == Approx(1.0 / 3));
  CHECK(huber(4.0, 2.0).cost == Approx(2.0));
}

TEST_CASE("Geman-McClure is bounded by delta^2 / 2") {
  CHECK(geman_mcclure(0.01, 0.1).cost == Approx(0.0025));
  CHECK(geman_mcclure(0.01, 0.1).weight == Approx(0.25));
  CHECK(geman_mcclure(1e12, 0.1).cost == Approx(0.005));
  CHECK(geman_mcclure(1e12, 0.1).weight < 1e-20);
}

TEST_CASE("no kernel is least squares") {
  CHECK(robust_cost({}, 8.0).cost == 4.0);
  CHECK(robust_cost({}, 8.0).weight == 1.0);
}

TEST_CASE("the weight follows from the cost") {
  for (const RobustKernelKind kind :
       {RobustKernelKind::kNone, RobustKernelKind::kHuber, RobustKernelKind::kGemanMcClure}) {
    for (const double u : {0.0, 0.01, 0.29, 0.31, 2.0}) {
      const RobustKernel kernel{kind, 0.3};
      const RobustCost robust = robust_cost(kernel, u * u);
      CHECK(robust_weight(kernel, robust.cost) == Approx(robust.weight));
    }
  }
}

TEST_CASE("the weight is the derivative of the cost over u") {
  for (const RobustKernelKind kind :
       {RobustKernelKind::kNone, RobustKernelKind::kHuber, RobustKernelKind::kGemanMcClure}) {
    for (const double u : {0.01, 0.29, 0.31, 2.0, 50.0}) {
      const RobustKernel kernel{kind, 0.3};
      const double h = 1e-5 * u;
      const double slope = (robust_cost(kernel, (u + h) * (u + h)).cost -
                            robust_cost(kernel, (u - h) * (u - h)).cost) /
                           (2.0 * h);
      CHECK(robust_cost(kernel, u * u).weight == Approx(slope / u).margin(1e-9));
    }
  }
}
