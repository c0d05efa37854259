// SPDX-License-Identifier: MIT
// A pose graph as it stands in a file: which reader.
#include "tools/bench/solver/pose_graph.hpp"

#include <filesystem>

#include "drivers/sequence/text_file.hpp"

namespace unisim::bench {

PoseGraph read_pose_graph(const std::string& path) {
  const std::string end = std::filesystem::path(path).extension().string();
  if (end != ".usg" && end != ".g2o") {
    throw sequence::InputError(path + ": a graph file ends in .usg or .g2o");
  }
  PoseGraph graph = end == ".usg" ? read_usg(path) : read_g2o(path);
  if (graph.edges.empty()) throw sequence::InputError(path + ": the graph has no edges");
  return graph;
}

}  // namespace unisim::bench
