// SPDX-License-Identifier: MIT
// Sorts pose edges into quads of one shape as they come.
#pragma once

#include "core/solve/linearize/pose_quad.hpp"

namespace unisim {

/// One edge of a quad; fields as those of PoseQuad.
struct QuadEdge {
  const double* A = nullptr;
  const double* B = nullptr;
  const double* P = nullptr;
  const double* Q = nullptr;
  const double* Lambda = nullptr;
  double weight = 1.0;
  double delta = 1.0;
  bool geman_mcclure = false;
  Block* H_aa = nullptr;
  Block* H_bb = nullptr;
  Block* H_ab = nullptr;
  double* g_a = nullptr;
  double* g_b = nullptr;
  double* cost = nullptr;
};

/// Adds edges to the normal equations, four of a shape at a time. The order of the sums depends on
/// the edges handed in and on nothing else.
class QuadCollector {
 public:
  QuadCollector();

  void add(QuadShape shape, bool a_is_later, const QuadEdge& edge);
  /// Adds nothing to the blocks of H, whose fields need no value.
  void add_gradient(QuadShape shape, const QuadEdge& edge);
  /// Adds what is left.
  void finish();

 private:
  struct Group {
    PoseQuad quad;
    int32_t count = 0;
  };
  void add(const QuadEdge& edge, Group* group);
  void flush(Group* group);

  Group groups_[2 * kQuadShapes];
  Group gradients_[kQuadShapes];
  double sink_ = 0.0;  // cost of what fills a quad
};

}  // namespace unisim
