// SPDX-License-Identifier: MIT
// Edges four at a time against the formulas of one edge.
#include "core/solve/linearize/pose_quad.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "core/base/cpu.hpp"
#include "core/graph/chain.hpp"
#include "core/graph/relative_pose.hpp"
#include "core/graph/rigid.hpp"
#include "core/graph/robust_kernel.hpp"
#include "core/solve/linearize/quad_collector.hpp"
#include "core/solve/order/block_map.hpp"
#include "tests/support/catch.hpp"
#include "tests/unit/core_support.hpp"

using namespace unisim;
using unisim_test::difference;
using unisim_test::kPi;
using unisim_test::Random;
using Dense = Eigen::Matrix<double, 7, 7>;

namespace {

// An edge with blocks of its own.
struct TestEdge {
  Sim3 A, B, P, Q;
  Mat7 Lambda = Mat7::Identity();
  double weight = 1.0;
  RobustKernel kernel;
  Block H_aa{}, H_bb{}, H_ab{};
  BlockVector g_a{}, g_b{};
  double cost = 0.0;

  QuadEdge quad_edge(QuadShape shape) {
    QuadEdge out;
    out.A = A.q.coeffs().data();
    out.B = B.q.coeffs().data();
    out.P = P.q.coeffs().data();
    out.Q = shape == QuadShape::kTwoMeasurements ? Q.q.coeffs().data() : nullptr;
    out.Lambda = Lambda.data();
    out.weight = weight;
    out.delta = kernel.kind == RobustKernelKind::kNone ? std::numeric_limits<double>::infinity()
                                                       : kernel.delta;
    out.geman_mcclure = kernel.kind == RobustKernelKind::kGemanMcClure;
    out.H_aa = &H_aa;
    out.H_bb = &H_bb;
    out.H_ab = &H_ab;
    out.g_a = g_a.v;
    out.g_b = g_b.v;
    out.cost = &cost;
    return out;
  }
};

// Residual of about this angle [rad] and log-scale.
TestEdge edge_with(Random& random, QuadShape shape, double angle, double log_scale) {
  TestEdge edge;
  const double scale = shape == QuadShape::kRigid ? 0.0 : 1.0;
  edge.A = random.pose(3.0, 3.0, scale);
  edge.P = random.pose(2.0, 2.0, 0.5 * scale);
  if (shape == QuadShape::kTwoMeasurements) edge.Q = random.pose(2.0, 2.0, 0.5);
  const Sim3 error = sim3_exp(random.tangent(0.5, angle, scale * log_scale));
  edge.B = edge.A * edge.P * error * edge.Q.inverse();
  edge.weight = random.uniform(0.1, 3.0);
  edge.kernel.kind = static_cast<RobustKernelKind>(random.below(3));
  edge.kernel.delta = random.uniform(0.05, 1.0);
  if (shape == QuadShape::kChain || shape == QuadShape::kRigid) {
    Mat7 M;
    for (int k = 0; k < M.size(); ++k) M.data()[k] = random.uniform(-1.0, 1.0);
    edge.Lambda += M * M.transpose();
  }
  if (shape == QuadShape::kRigid) {
    edge.Lambda.row(6).setZero();
    edge.Lambda.col(6).setZero();
    edge.Lambda(6, 6) = 1.0;
  }
  return edge;
}

struct Expected {
  Vec7 e;
  Dense J_a, J_b;
};

Expected expected_of(const TestEdge& edge, QuadShape shape) {
  Expected out;
  if (shape == QuadShape::kRigid) {
    const RigidJacobians J = rigid_jacobians(edge.A, edge.B, edge.P);
    out.e << J.e, 0.0;
    out.J_a = out.J_b = Dense::Zero();
    out.J_a.topLeftCorner<6, 6>() = J.J_e_a;
    out.J_b.topLeftCorner<6, 6>() = J.J_e_b;
    return out;
  }
  const RelativePoseJacobians J = relative_pose_jacobians(edge.A, edge.B, edge.P, edge.Q);
  return {J.e, J.J_e_A, J.J_e_B};
}

Dense full(const Block& lower) {
  const Dense L = as_matrix(lower).triangularView<Eigen::Lower>();
  return L + L.transpose() - Dense(L.diagonal().asDiagonal());
}

// Entries against those of the formula, relative to the largest term of their sums.
void check_edge(const TestEdge& edge, QuadShape shape, bool a_is_later) {
  const Expected J = expected_of(edge, shape);
  const double u_squared = edge.weight * J.e.dot(edge.Lambda * J.e);
  const RobustCost robust = robust_cost(edge.kernel, u_squared);
  const Dense L = edge.weight * robust.weight * edge.Lambda;
  Dense H_aa = J.J_a.transpose() * L * J.J_a;
  Dense H_bb = J.J_b.transpose() * L * J.J_b;
  const Dense H_ba = J.J_b.transpose() * L * J.J_a;
  if (shape == QuadShape::kRigid) {
    H_aa(6, 6) = edge.weight * robust.weight;
    H_bb(6, 6) = edge.weight * robust.weight;
  }
  const double size = 1.0 + std::max(H_aa.cwiseAbs().maxCoeff(), H_bb.cwiseAbs().maxCoeff());
  const double tolerance = 1e-11 * size;
  CHECK(difference(full(edge.H_aa), H_aa) < tolerance);
  CHECK(difference(full(edge.H_bb), H_bb) < tolerance);
  const Dense coupling = as_matrix(edge.H_ab);
  CHECK(difference(a_is_later ? Dense(coupling.transpose()) : coupling, H_ba) < tolerance);
  CHECK(difference(Eigen::Map<const Vec7>(edge.g_a.v), J.J_a.transpose() * L * J.e) < tolerance);
  CHECK(difference(Eigen::Map<const Vec7>(edge.g_b.v), J.J_b.transpose() * L * J.e) < tolerance);
  for (int column = 0; column < kTangentDim; ++column) {
    CHECK(edge.H_ab.v[kBlockRows * column + kTangentDim] == 0.0);
    CHECK(edge.H_bb.v[kBlockRows * column + kTangentDim] == 0.0);
  }
}

double expected_cost(const TestEdge& edge, QuadShape shape) {
  const Expected J = expected_of(edge, shape);
  return robust_cost(edge.kernel, edge.weight * J.e.dot(edge.Lambda * J.e)).cost;
}

double collect(QuadShape shape, bool a_is_later, std::vector<TestEdge>* edges) {
  QuadCollector quads;
  for (TestEdge& edge : *edges) quads.add(shape, a_is_later, edge.quad_edge(shape));
  quads.finish();
  double cost = 0.0;
  for (const TestEdge& edge : *edges) cost += edge.cost;
  return cost;
}

constexpr QuadShape kShapes[] = {QuadShape::kOneMeasurement, QuadShape::kTwoMeasurements,
                                 QuadShape::kChain, QuadShape::kRigid};

// Both sides of every choice: series or closed form, small angles, angles near pi.
std::vector<TestEdge> edges_of_all_sizes(QuadShape shape) {
  Random random(17);
  std::vector<TestEdge> edges;
  for (const double angle :
       {0.0, 1e-12, 1e-8, 1e-4, 0.05, 0.3, 0.489, 0.491, 0.6, 1.5, 3.0, kPi - 1e-3}) {
    for (const double log_scale : {0.0, 1e-10, -1e-3, 0.2, -0.28, 0.286, 0.29, -0.5, 1.2}) {
      edges.push_back(edge_with(random, shape, angle, log_scale));
    }
  }
  return edges;
}

}  // namespace

TEST_CASE("edges four at a time are the formula of one, all shapes and sizes of residual") {
  for (const QuadShape shape : kShapes) {
    for (const bool a_is_later : {false, true}) {
      std::vector<TestEdge> edges = edges_of_all_sizes(shape);
      double cost = 0.0;
      for (const TestEdge& edge : edges) cost += expected_cost(edge, shape);
      CHECK(collect(shape, a_is_later, &edges) == Approx(cost));
      for (size_t i = 0; i < edges.size(); ++i) {
        CAPTURE(static_cast<int>(shape), i);
        check_edge(edges[i], shape, a_is_later);
      }
    }
  }
}

TEST_CASE("any number of edges is taken, each once") {
  Random random(3);
  for (const QuadShape shape : kShapes) {
    for (int count = 1; count <= 9; ++count) {
      std::vector<TestEdge> edges;
      double cost = 0.0;
      for (int i = 0; i < count; ++i) {
        edges.push_back(edge_with(random, shape, 0.2, 0.1));
        cost += expected_cost(edges.back(), shape);
      }
      CHECK(collect(shape, false, &edges) == Approx(cost));
      for (const TestEdge& edge : edges) check_edge(edge, shape, false);
    }
  }
}

TEST_CASE("an edge gets the same bits whatever its neighbours are") {
  Random random(8);
  for (const QuadShape shape : kShapes) {
    std::vector<TestEdge> edges = edges_of_all_sizes(shape);
    std::vector<TestEdge> alone = edges;
    collect(shape, false, &edges);
    for (size_t i = 0; i < edges.size(); ++i) {
      std::vector<TestEdge> one(1, alone[i]);
      collect(shape, false, &one);
      CAPTURE(static_cast<int>(shape), i);
      CHECK(std::memcmp(&one[0].H_aa, &edges[i].H_aa, sizeof(Block)) == 0);
      CHECK(std::memcmp(&one[0].H_ab, &edges[i].H_ab, sizeof(Block)) == 0);
      CHECK(std::memcmp(&one[0].g_b, &edges[i].g_b, sizeof(BlockVector)) == 0);
    }
  }
}

TEST_CASE("the gradient alone is that of the whole, bit for bit") {
  for (const QuadShape shape : kShapes) {
    std::vector<TestEdge> whole = edges_of_all_sizes(shape);
    std::vector<TestEdge> gradient = whole;
    collect(shape, false, &whole);
    QuadCollector collector;
    for (TestEdge& edge : gradient) {
      QuadEdge out = edge.quad_edge(shape);
      out.H_aa = out.H_bb = out.H_ab = nullptr;
      collector.add_gradient(shape, out);
    }
    collector.finish();
    for (size_t i = 0; i < whole.size(); ++i) {
      CAPTURE(static_cast<int>(shape), i);
      CHECK(std::memcmp(&whole[i].g_a, &gradient[i].g_a, sizeof(BlockVector)) == 0);
      CHECK(std::memcmp(&whole[i].g_b, &gradient[i].g_b, sizeof(BlockVector)) == 0);
      CHECK(whole[i].cost == gradient[i].cost);
    }
  }
}

TEST_CASE("a residual that is no number makes a cost that is none") {
  Random random(8);
  std::vector<TestEdge> edges(3, edge_with(random, QuadShape::kOneMeasurement, 0.1, 0.1));
  edges[1].B.t.x() = std::nan("");
  CHECK(!std::isfinite(collect(QuadShape::kOneMeasurement, false, &edges)));
}

#ifdef UNISIM_HAS_WIDE_VECTORS
TEST_CASE("both instruction sets give the same bits") {
  if (!cpu_has_avx2()) {
    WARN("skipped: the processor has no AVX2");
    return;
  }
  for (const QuadShape shape : kShapes) {
    std::vector<TestEdge> edges = edges_of_all_sizes(shape);
    for (size_t i = 0; i + 3 < edges.size(); i += 4) {
      // Neighbours share a node, as in a chain: the order of the sums counts.
      Block nodes[2][5] = {};
      BlockVector gradients[2][5] = {};
      Block couplings[2] = {};
      double cost[2][4];
      for (const int wide : {0, 1}) {
        PoseQuad quad;
        quad.shape = shape;
        for (size_t k = 0; k < 4; ++k) {
          const QuadEdge edge = edges[i + k].quad_edge(shape);
          quad.A[k] = edge.A;
          quad.B[k] = edge.B;
          quad.P[k] = edge.P;
          quad.Q[k] = edge.Q;
          quad.Lambda[k] = edge.Lambda;
          quad.weight[k] = edge.weight;
          quad.delta[k] = edge.delta;
          quad.geman_mcclure[k] = edge.geman_mcclure ? 1.0 : 0.0;
          quad.H_aa[k] = &nodes[wide][k];
          quad.H_bb[k] = &nodes[wide][k + 1];
          quad.H_ab[k] = &couplings[wide];
          quad.g_a[k] = gradients[wide][k].v;
          quad.g_b[k] = gradients[wide][k + 1].v;
          quad.cost[k] = &cost[wide][k];
        }
        wide == 1 ? avx2::add_pose_quad(quad) : baseline::add_pose_quad(quad);
      }
      CAPTURE(static_cast<int>(shape), i);
      CHECK(std::memcmp(cost[0], cost[1], sizeof cost[0]) == 0);
      CHECK(std::memcmp(nodes[0], nodes[1], sizeof nodes[0]) == 0);
      CHECK(std::memcmp(gradients[0], gradients[1], sizeof gradients[0]) == 0);
      CHECK(std::memcmp(&couplings[0], &couplings[1], sizeof couplings[0]) == 0);
    }
  }
}
#endif
