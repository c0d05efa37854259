// SPDX-License-Identifier: MIT
// A pose graph from the text of its file.
#pragma once

#include <string>

#include "tests/support/temp_folder.hpp"
#include "tools/bench/solver/pose_graph.hpp"

/// @param name of the file: its ending says the format
inline unisim::bench::PoseGraph graph_of(const std::string& text,
                                         const std::string& name = "graph.usg") {
  const TempFolder folder;
  folder.write(name, text);
  return unisim::bench::read_pose_graph(folder / name);
}
