// SPDX-License-Identifier: MIT
// The scale of simulated walks: predictions as unsure as those of a network, odometry with noise
// and slips.
#include <cmath>
#include <cstdio>
#include <vector>

#include "drivers/pipeline/odometry.hpp"
#include "tests/pipeline/scripted_run.hpp"
#include "tests/pipeline/walk_predictor.hpp"
#include "tests/support/temp_folder.hpp"
#include "tools/bench/simulator/noise_source.hpp"
#include "tools/eval/alignment.hpp"

using namespace unisim;
using namespace unisim::testing;

namespace {

constexpr int32_t kKeyframes = 300;

/// Steps with 2 % noise each; a share of them, eight in a row, is 40 % too long.
Odometry odometry_of(const simulator::World& world, double slips, uint64_t seed) {
  simulator::NoiseSource noise(seed);
  std::string text;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  double slip = 1.0;
  for (int32_t k = 0; k < world.keyframes(); ++k) {
    const auto now = static_cast<size_t>(k);
    if (k % 8 == 0) slip = noise.uniform(0.0, 1.0) < slips ? 1.4 : 1.0;
    if (k > 0) {
      const Eigen::Vector3d step = world.T_world_kf[now].t - world.T_world_kf[now - 1].t;
      at += step * (1.0 + noise.normal(0.02)) * slip;
    }
    char line[128];
    std::snprintf(line, sizeof line, "%.9f %.9f %.9f %.9f\n", 0.033333333 * k, at.x(), at.y(),
                  at.z());
    text += line;
  }
  const TempFolder folder;
  return Odometry::read(folder.write("odometry.txt", text));
}

struct MetricWalk {
  MetricWalk(double slips, uint64_t seed)
      : world(simulator::make_world(simulator::WorldKind::kWalk, kKeyframes, seed)),
        odometry(odometry_of(world, slips, 1000 + seed)),
        source(world.keyframes()),
        predictor(world, seed) {
    REQUIRE(unisim_config_init(&config, sizeof config) == UNISIM_OK);
    config.max_keyframes = 512;
    config.window_submaps = 2;
    options.keyframes.stride = 1;
    options.loops.places = 0;
    options.odometry = {&odometry, 0.02};
  }

  void go() {
    pipeline = std::make_unique<Pipeline>(options, source.table(), predictor.table(), config,
                                          std::vector<Listener*>{});
    REQUIRE(pipeline->run().outcome == Outcome::kFinished);
  }

  std::vector<Eigen::Vector3d> positions() const {
    std::vector<Eigen::Vector3d> found;
    for (int32_t k = 0; k < kKeyframes; ++k) {
      unisim_pose out{};
      out.struct_size = sizeof out;
      REQUIRE(unisim_get_pose(pipeline->session(), k, &out) == UNISIM_OK);
      found.emplace_back(out.T_world_kf.t);
    }
    return found;
  }

  /// Of the Sim(3) that lays the map on the truth.
  double true_metres_per_unit() const {
    std::vector<Eigen::Vector3d> truth;
    for (const simulator::RigidPose& T : world.T_world_kf) truth.push_back(T.t);
    return eval::align(positions(), truth, eval::Alignment::kSim3).s;
  }

  unisim_scale scale() const {
    unisim_scale out{};
    out.struct_size = sizeof out;
    REQUIRE(unisim_get_scale(pipeline->session(), 0, &out) == UNISIM_OK);
    return out;
  }

  simulator::World world;
  Odometry odometry;
  ScriptedSource source;
  WalkPredictor predictor;
  unisim_config config;
  Options options;
  std::unique_ptr<Pipeline> pipeline;
};

}  // namespace

TEST_CASE("the scale of a walk lies within its standard deviation, with and without slips") {
  const double slips = GENERATE(0.0, 0.1);
  constexpr int kSeeds = 20;
  double squares = 0.0;
  double chi2 = 0.0;
  int beyond = 0;
  for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
    MetricWalk walk(slips, seed);
    walk.go();
    const unisim_scale scale = walk.scale();
    const double error = std::log(scale.metres_per_unit / walk.true_metres_per_unit());
    const double whitened = error / scale.sigma;
    INFO("seed " << seed << ": error " << error << ", sigma " << scale.sigma << ", refused "
                 << scale.refused);
    CHECK(std::abs(error) < (slips > 0.0 ? 0.1 : 0.02));
    squares += error * error / kSeeds;
    chi2 += whitened * whitened;
    beyond += std::abs(whitened) > 3.0 ? 1 : 0;
  }
  INFO("rms " << std::sqrt(squares) << ", mean square whitened " << chi2 / kSeeds);
  CHECK(beyond <= 1);
  CHECK(chi2 / kSeeds > 0.05);
  CHECK(chi2 / kSeeds < 2.0);
}
