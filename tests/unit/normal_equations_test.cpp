// SPDX-License-Identifier: MIT
// Normal equations against the products of the factors' Jacobians.
#include "core/solve/linearize/normal_equations.hpp"

#include "core/graph/bridge.hpp"
#include "core/graph/tie.hpp"
#include "core/graph/two_view.hpp"
#include "tests/support/catch.hpp"
#include "tests/unit/core_support.hpp"

using namespace unisim;
using unisim_test::CarvedGraph;
using unisim_test::difference;
using CarvedPattern = unisim_test::Carved<BlockPattern, SolverCapacity>;
using CarvedEquations = unisim_test::Carved<NormalEquations, SolverCapacity>;
using Dense = Eigen::Matrix<double, 7, 7>;

namespace {

// Two nodes and one edge; H and g as the solver has them, in the order of nodes a, b.
struct Pair {
  Pair() : graph({2, 1, 2, 1}), pattern({2, 1, 1, 3}), equations({2, 1, 1, 3}) {
    unisim_test::Random random(11);
    A = random.pose(2.0, 2.0, 0.5);
    B = random.pose(2.0, 2.0, 0.5);
    P = random.pose(1.0, 1.0, 0.3);
    Q = random.pose(1.0, 1.0, 0.3);
    weight.information = 3.0;
    weight.multiplier = 0.5;
    weight.kernel = {RobustKernelKind::kHuber, 0.7};
    int32_t id = -1;
    REQUIRE(graph->add_node(NodeKind::kSubmap, A, &id) == Status::kOk);
    REQUIRE(graph->add_node(NodeKind::kSubmap, B, &id) == Status::kOk);
  }

  double linearize() {
    REQUIRE(pattern->build(*graph) == Status::kOk);
    const unisim_test::Assembled assembled(*equations, *graph, *pattern);
    H = assembled.dense();
    return assembled.cost();
  }
  Dense diagonal(int32_t node) {
    const int32_t at = 7 * pattern->column_of_node(node);
    return H.block<7, 7>(at, at);
  }
  // Rows of node 1, columns of node 0.
  Dense off_diagonal() {
    return H.block<7, 7>(7 * pattern->column_of_node(1), 7 * pattern->column_of_node(0));
  }
  Vec7 gradient(int32_t node) {
    return Eigen::Map<const Vec7>(equations->gradient()[pattern->column_of_node(node)].v);
  }
  void check_against(const RelativePoseJacobians& J) {
    const double u2 = 1.5 * J.e.squaredNorm();
    const RobustCost robust = robust_cost(weight.kernel, u2);
    const double w = 1.5 * robust.weight;
    CHECK(linearize() == Approx(robust.cost));
    CHECK(robust.weight < 1.0);
    CHECK(difference(diagonal(0), w * J.J_e_A.transpose() * J.J_e_A) < 1e-12);
    CHECK(difference(diagonal(1), w * J.J_e_B.transpose() * J.J_e_B) < 1e-12);
    CHECK(difference(off_diagonal(), w * J.J_e_B.transpose() * J.J_e_A) < 1e-12);
    CHECK(difference(gradient(0), w * J.J_e_A.transpose() * J.e) < 1e-12);
    CHECK(difference(gradient(1), w * J.J_e_B.transpose() * J.e) < 1e-12);
  }

  CarvedGraph graph;
  CarvedPattern pattern;
  CarvedEquations equations;
  Eigen::MatrixXd H;
  Sim3 A, B, P, Q;
  EdgeWeight weight;
};

Mat7 information(uint32_t seed) {
  unisim_test::Random random(seed);
  Mat7 M;
  for (int k = 0; k < M.size(); ++k) M.data()[k] = random.uniform(-1.0, 1.0);
  return 10.0 * M * M.transpose() + Mat7::Identity();
}

}  // namespace

TEST_CASE("a two-view edge adds w J'J and w J'e") {
  Pair pair;
  int32_t id = -1;
  REQUIRE(pair.graph->add_two_view(0, 1, pair.P, pair.weight, &id) == Status::kOk);
  pair.check_against(two_view_jacobians(pair.A, pair.B, pair.P));
}

TEST_CASE("a bridge edge adds w J'J and w J'e") {
  Pair pair;
  int32_t id = -1;
  REQUIRE(pair.graph->add_bridge(0, 1, pair.P, pair.weight, &id) == Status::kOk);
  pair.check_against(bridge_jacobians(pair.A, pair.B, pair.P));
}

TEST_CASE("a tie edge adds w J'J and w J'e") {
  Pair pair;
  int32_t id = -1;
  REQUIRE(pair.graph->add_tie(0, 1, pair.P, pair.Q, pair.weight, &id) == Status::kOk);
  pair.check_against(tie_jacobians(pair.A, pair.B, pair.P, pair.Q));
}

TEST_CASE("scale edges touch the log-scales only") {
  for (const bool anchor : {true, false}) {
    Pair pair;
    int32_t id = -1;
    const Status status = anchor ? pair.graph->add_scale_anchor(0, 1, 0.1, {}, &id)
                                 : pair.graph->add_scale(0, 1, 0.1, {}, &id);
    REQUIRE(status == Status::kOk);
    const double e = std::log(pair.B.s / pair.A.s) - 0.1;
    CHECK(pair.linearize() == Approx(0.5 * e * e));
    Dense expected = Dense::Zero();
    expected(6, 6) = 1.0;
    CHECK(difference(pair.diagonal(0), expected) == 0.0);
    CHECK(difference(pair.off_diagonal(), -expected) == 0.0);
    CHECK(pair.gradient(1)(6) == Approx(e));
    CHECK(pair.gradient(0)(6) == Approx(-e));
  }
}

TEST_CASE("suspended edges and fixed ends add nothing of their own") {
  Pair pair;
  int32_t id = -1;
  REQUIRE(pair.graph->add_two_view(0, 1, pair.P, pair.weight, &id) == Status::kOk);
  REQUIRE(pair.graph->set_fixed(0, true) == Status::kOk);
  const RelativePoseJacobians J = two_view_jacobians(pair.A, pair.B, pair.P);
  const RobustCost robust = robust_cost(pair.weight.kernel, 1.5 * J.e.squaredNorm());
  CHECK(pair.linearize() == Approx(robust.cost));
  const double w = 1.5 * robust.weight;
  CHECK(difference(pair.diagonal(1), w * J.J_e_B.transpose() * J.J_e_B) < 1e-12);
  REQUIRE(pair.graph->set_suspended(id, true) == Status::kOk);
  CHECK(pair.linearize() == 0.0);
  CHECK(pair.diagonal(1).norm() == 0.0);
}

TEST_CASE("a chain edge adds w J' Lambda J and w J' Lambda e") {
  for (const RobustKernelKind kind :
       {RobustKernelKind::kNone, RobustKernelKind::kHuber, RobustKernelKind::kGemanMcClure}) {
    Pair pair;
    pair.weight.kernel.kind = kind;
    const ChainLink link = {pair.P, information(3)};
    int32_t id = -1;
    REQUIRE(pair.graph->add_chain(0, 1, link, pair.weight, &id) == Status::kOk);
    const Dense J_a = unisim_test::numeric_jacobian(
        pair.A, [&](const Sim3& A) { return chain_residual(A, pair.B, pair.P); });
    const Dense J_b = unisim_test::numeric_jacobian(
        pair.B, [&](const Sim3& B) { return chain_residual(pair.A, B, pair.P); });
    const Vec7 e = chain_residual(pair.A, pair.B, pair.P);
    const RobustCost robust = robust_cost(pair.weight.kernel, 1.5 * e.dot(link.Lambda * e));
    const Dense L = 1.5 * robust.weight * link.Lambda;
    const double tolerance = 1e-6 * L.norm();
    CHECK(pair.linearize() == Approx(robust.cost));
    CHECK(pair.graph->cost() == Approx(robust.cost));
    CHECK(pair.graph->edge_norm(id) == Approx(std::sqrt(1.5 * e.dot(link.Lambda * e))));
    CHECK(difference(pair.diagonal(0), J_a.transpose() * L * J_a) < tolerance);
    CHECK(difference(pair.diagonal(1), J_b.transpose() * L * J_b) < tolerance);
    CHECK(difference(pair.off_diagonal(), J_b.transpose() * L * J_a) < tolerance);
    CHECK(difference(pair.gradient(0), J_a.transpose() * L * e) < tolerance);
    CHECK(difference(pair.gradient(1), J_b.transpose() * L * e) < tolerance);
  }
}

TEST_CASE("a chain edge whose information is the identity is a two-view edge") {
  Pair chain;
  Pair two_view;
  int32_t id = -1;
  REQUIRE(chain.graph->add_chain(0, 1, {chain.P, Mat7::Identity()}, chain.weight, &id) ==
          Status::kOk);
  REQUIRE(two_view.graph->add_two_view(0, 1, two_view.P, two_view.weight, &id) == Status::kOk);
  CHECK(chain.linearize() == Approx(two_view.linearize()));
  for (const int32_t node : {0, 1}) {
    CHECK(difference(chain.diagonal(node), two_view.diagonal(node)) < 1e-12);
    CHECK(difference(chain.gradient(node), two_view.gradient(node)) < 1e-12);
  }
  CHECK(difference(chain.off_diagonal(), two_view.off_diagonal()) < 1e-12);
}

TEST_CASE("a chain edge wants room and a positive definite information") {
  Pair pair;
  int32_t id = -1;
  ChainLink link = {pair.P, information(3)};
  link.Lambda(2, 2) = -1.0;
  CHECK(pair.graph->add_chain(0, 1, link, {}, &id) == Status::kInvalidArgument);
  link.Lambda = information(3);
  link.Lambda(1, 0) += 1.0;
  CHECK(pair.graph->add_chain(0, 1, link, {}, &id) == Status::kInvalidArgument);
  link.Lambda(1, 0) = std::nan("");
  CHECK(pair.graph->add_chain(0, 1, link, {}, &id) == Status::kInvalidArgument);
  link.Lambda = information(3);
  CHECK(pair.graph->add_chain(0, 0, link, {}, &id) == Status::kInvalidArgument);
  CarvedGraph no_chains(GraphCapacity{2, 2, 2, 0});
  int32_t node = -1;
  REQUIRE(no_chains->add_node(NodeKind::kSubmap, pair.A, &node) == Status::kOk);
  REQUIRE(no_chains->add_node(NodeKind::kSubmap, pair.B, &node) == Status::kOk);
  CHECK(no_chains->add_chain(0, 1, link, {}, &id) == Status::kCapacity);
  CHECK(no_chains->edge_count() == 0);
  for (int k = 0; k < 3; ++k) {
    REQUIRE(pair.graph->add_chain(0, 1, link, {}, &id) == Status::kOk);
    CHECK(pair.graph->add_chain(0, 1, link, {}, &id) == Status::kCapacity);
    REQUIRE(pair.graph->remove_edge(id) == Status::kOk);
  }
}

TEST_CASE("a rigid edge adds J' Lambda J, holds the log-scales and counts half of e' Lambda e") {
  Pair pair;
  pair.A.s = pair.B.s = pair.P.s = 1.0;
  REQUIRE(pair.graph->set_pose(0, pair.A) == Status::kOk);
  REQUIRE(pair.graph->set_pose(1, pair.B) == Status::kOk);
  const Mat6 Lambda = information(3).topLeftCorner<6, 6>();
  int32_t id = -1;
  REQUIRE(pair.graph->add_rigid(0, 1, pair.P, Lambda, {}, &id) == Status::kOk);
  const RigidJacobians J = rigid_jacobians(pair.A, pair.B, pair.P);
  CHECK(pair.linearize() == Approx(0.5 * J.e.dot(Lambda * J.e)));
  CHECK(pair.graph->cost() == Approx(0.5 * J.e.dot(Lambda * J.e)));
  Dense H = Dense::Zero();
  H(6, 6) = 1.0;
  H.topLeftCorner<6, 6>() = J.J_e_b.transpose() * Lambda * J.J_e_b;
  CHECK(difference(pair.diagonal(1), H) < 1e-12 * H.norm());
  H.topLeftCorner<6, 6>() = J.J_e_a.transpose() * Lambda * J.J_e_a;
  CHECK(difference(pair.diagonal(0), H) < 1e-12 * H.norm());
  CHECK(pair.gradient(0)(6) == 0.0);
  CHECK(pair.gradient(1)(6) == 0.0);
  Sim3 scaled = pair.P;
  scaled.s = 1.5;
  CHECK(pair.graph->add_rigid(0, 1, scaled, Lambda, {}, &id) == Status::kInvalidArgument);
}
