// SPDX-License-Identifier: MIT
// A pose graph as it stands in a file.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "core/graph/rigid.hpp"

namespace unisim::bench {

struct FileNode {
  Sim3 T_world_node;
  bool submap = false;
  bool fixed = false;
};

enum class FileEdgeKind { kTwoView, kBridge, kTie, kScaleAnchor, kScale, kRigid };

/// Cost of an edge: weight * H(|e|), H Huber with width `huber` (<= 0: quadratic), e the residual
/// of the factor; kRigid: e' information e / 2 with e = (translation, quaternion vector) of
/// P^-1 A^-1 B.
struct FileEdge {
  FileEdgeKind kind = FileEdgeKind::kTwoView;
  int32_t a = -1;  ///< place in PoseGraph::nodes
  int32_t b = -1;
  double weight = 1.0;
  double huber = 0.0;
  Sim3 P;                    ///< measurement; of a tie the first one
  Sim3 Q;                    ///< ties only
  double log_ratio = 0.0;    ///< kScaleAnchor and kScale
  int32_t information = -1;  ///< kRigid: place in PoseGraph::information
};

struct PoseGraph {
  std::vector<FileNode> nodes;
  std::vector<FileEdge> edges;
  std::vector<Mat6> information;
};

/// Read a graph, .usg or .g2o by the end of its name.
/// @throws sequence::InputError with file and line when the file is not such a graph
PoseGraph read_pose_graph(const std::string& path);

/// Text format usg 1: similarities with two-view, bridge, tie, anchor and scale edges.
PoseGraph read_usg(const std::string& path);

/// g2o text with VERTEX_SE3:QUAT and EDGE_SE3:QUAT. FIX holds a vertex; without one the first is
/// held.
PoseGraph read_g2o(const std::string& path);

}  // namespace unisim::bench
