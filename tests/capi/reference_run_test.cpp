// SPDX-License-Identifier: MIT
// A session fed the stored predictions finds the poses of the numpy reference, in both presets.
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "tests/capi/world.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::test;

namespace {

constexpr int32_t kDepthSide = 7;
constexpr size_t kPixels = kDepthSide * kDepthSide;

unisim_sim3 read_pose(std::istringstream& in) {
  unisim_sim3 T = {};
  for (double& value : T.q) in >> value;
  for (double& value : T.t) in >> value;
  T.s = 1.0;
  return T;
}

Depth read_depth(std::istringstream& in) {
  std::vector<float> pixels(kPixels);
  for (float& pixel : pixels) in >> pixel;
  REQUIRE(in);
  return {pixels, kDepthSide};
}

/// What reference_run.txt holds.
struct ReferenceRun {
  std::vector<Pair> pairs;
  std::vector<Views> windows;
  std::map<std::string, std::vector<unisim_sim3>> poses;

  explicit ReferenceRun(const std::string& path) {
    std::ifstream file(path);
    REQUIRE(file);
    for (std::string line; std::getline(file, line);) {
      std::istringstream in(line);
      std::string kind;
      in >> kind;
      if (kind == "pair") add_pair(in);
      if (kind == "view") add_view(in);
      if (kind == "pose") add_pose(in);
    }
    for (Views& window : windows) {
      for (const Depth& depth : window.depth) window.maps.push_back(depth.map());
    }
  }

  void add_pair(std::istringstream& in) {
    Pair pair;
    pair.two_view = {};
    pair.two_view.struct_size = sizeof pair.two_view;
    in >> pair.two_view.i;
    pair.two_view.j = pair.two_view.i + 1;
    pair.two_view.T_i_j = read_pose(in);
    pair.depth_i = read_depth(in);
    pair.depth_j = read_depth(in);
    pairs.push_back(pair);
  }

  void add_view(std::istringstream& in) {
    size_t window = 0;
    int32_t keyframe = -1;
    in >> window >> keyframe;
    windows.resize(window + 1);
    windows[window].ids.push_back(keyframe);
    windows[window].T_submap_kf.push_back(read_pose(in));
    windows[window].depth.push_back(read_depth(in));
  }

  void add_pose(std::istringstream& in) {
    std::string preset;
    int32_t keyframe = -1;
    in >> preset >> keyframe;
    unisim_sim3 T = read_pose(in);
    in >> T.s;
    poses[preset].push_back(T);
  }
};

}  // namespace

TEST_CASE("a session agrees with the numpy reference") {
  const auto [preset, window_submaps, name] =
      GENERATE(table<int32_t, int32_t, std::string>({{UNISIM_PRESET_CONSISTENT, 0, "consistent"},
                                                     {UNISIM_PRESET_CONSISTENT, 2, "window"},
                                                     {UNISIM_PRESET_PAPER, 0, "paper"}}));
  const ReferenceRun run(UNISIM_REFERENCE_RUN);
  unisim_config config = default_config();
  config.preset = preset;
  config.window_submaps = window_submaps;
  config.window_size = 8;
  config.window_overlap = 2;
  config.scatter_gate = 1.0;
  config.depth_grid_width = kDepthSide;
  config.depth_grid_height = kDepthSide;
  Host host(config);
  host.add_keyframe();
  size_t window = 0;
  const auto serve_window = [&] {
    if (host.next(UNISIM_REQUEST_WINDOW).kind == 0) return;
    REQUIRE(host.add_submap(run.windows.at(window++)) >= 0);
    // A sliding window keeps what it had found; each call stops early along weak directions.
    for (int k = 0; k < 10 * window_submaps; ++k) host.optimize();
  };
  for (const Pair& pair : run.pairs) {
    host.add_keyframe();
    REQUIRE(host.add_pair(pair) == UNISIM_OK);
    serve_window();
  }
  REQUIRE(unisim_close_window(host) == UNISIM_OK);
  serve_window();
  REQUIRE(window == run.windows.size());
  for (int k = 0; k < 5; ++k) host.optimize();  // each call stops early along weak directions
  constexpr double kTolerance = 1e-6;
  const unisim::Sim3 first = from_c(host.pose(0).T_world_kf);
  const std::vector<unisim_sim3>& expected = run.poses.at(name);
  for (size_t k = 0; k < expected.size(); ++k) {
    const auto id = static_cast<int32_t>(k);
    const unisim::Sim3 ours = between(first, from_c(host.pose(id).T_world_kf));
    const unisim::Vec7 difference = sim3_log(between(from_c(expected[k]), ours));
    CAPTURE(name, id, difference.transpose());
    CHECK(difference.cwiseAbs().maxCoeff() < kTolerance);
  }
}
