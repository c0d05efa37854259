// SPDX-License-Identifier: MIT
// Sorts pose edges into quads of one shape as they come.
#include "core/solve/linearize/quad_collector.hpp"

namespace unisim {
namespace {

void put(const QuadEdge& edge, int32_t place, PoseQuad* quad) {
  quad->A[place] = edge.A;
  quad->B[place] = edge.B;
  quad->P[place] = edge.P;
  quad->Q[place] = edge.Q;
  quad->Lambda[place] = edge.Lambda;
  quad->weight[place] = edge.weight;
  quad->delta[place] = edge.delta;
  quad->geman_mcclure[place] = edge.geman_mcclure ? 1.0 : 0.0;
  quad->H_aa[place] = edge.H_aa;
  quad->H_bb[place] = edge.H_bb;
  quad->H_ab[place] = edge.H_ab;
  quad->g_a[place] = edge.g_a;
  quad->g_b[place] = edge.g_b;
  quad->cost[place] = edge.cost;
}

// Fills a quad with its first edge at weight 0.
void pad(int32_t count, double* no_cost, PoseQuad* quad) {
  for (int32_t place = count; place < PoseQuad::kEdges; ++place) {
    quad->A[place] = quad->A[0];
    quad->B[place] = quad->B[0];
    quad->P[place] = quad->P[0];
    quad->Q[place] = quad->Q[0];
    quad->Lambda[place] = quad->Lambda[0];
    quad->weight[place] = 0.0;
    quad->delta[place] = quad->delta[0];
    quad->geman_mcclure[place] = 0.0;
    quad->H_aa[place] = quad->H_aa[0];
    quad->H_bb[place] = quad->H_bb[0];
    quad->H_ab[place] = quad->H_ab[0];
    quad->g_a[place] = quad->g_a[0];
    quad->g_b[place] = quad->g_b[0];
    quad->cost[place] = no_cost;
  }
}

}  // namespace

QuadCollector::QuadCollector() {
  for (int shape = 0; shape < kQuadShapes; ++shape) {
    gradients_[shape].quad.shape = static_cast<QuadShape>(shape);
    gradients_[shape].quad.gradient_only = true;
    for (int later = 0; later < 2; ++later) {
      groups_[2 * shape + later].quad.shape = static_cast<QuadShape>(shape);
      groups_[2 * shape + later].quad.a_is_later = later == 1;
    }
  }
}

void QuadCollector::add(QuadShape shape, bool a_is_later, const QuadEdge& edge) {
  add(edge, &groups_[2 * static_cast<int>(shape) + (a_is_later ? 1 : 0)]);
}

void QuadCollector::add_gradient(QuadShape shape, const QuadEdge& edge) {
  add(edge, &gradients_[static_cast<int>(shape)]);
}

void QuadCollector::add(const QuadEdge& edge, Group* group) {
  put(edge, group->count++, &group->quad);
  if (group->count == PoseQuad::kEdges) flush(group);
}

void QuadCollector::flush(Group* group) {
  if (group->count == 0) return;
  pad(group->count, &sink_, &group->quad);
  add_pose_quad(group->quad);
  group->count = 0;
}

void QuadCollector::finish() {
  for (Group& group : groups_) flush(&group);
  for (Group& group : gradients_) flush(&group);
}

}  // namespace unisim
