// SPDX-License-Identifier: MIT
// The part of the command line that every program that runs has: predictor, method, results.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/replay/options.hpp"

namespace CLI {
class App;
}

namespace unisim::replay {

/// Adds its options to a program's own; what is given waits here until the configuration file has
/// been read, for the command line goes before it.
class RunOptions {
 public:
  /// @param app, options must outlive it; options.settings gets its defaults
  RunOptions(CLI::App* app, Options* options);

  /// After parsing: the configuration file, then what was given. Throws Failure.
  void apply();
  /// What does not go together. Throws Failure (2).
  void check() const;

 private:
  void add_method_options(CLI::App* app);
  void add_scale_options(CLI::App* app);
  void add_camera_options(CLI::App* app);
  void add_map_options(CLI::App* app);
  void check_maps() const;
  void add_model_options(CLI::App* app);
  void add_output_options(CLI::App* app);
  void add_lcm_options(CLI::App* app);
  void take_models();
  void take_camera();

  Options* options_;
  std::string config_;
  std::optional<int32_t> stride_;
  std::optional<int32_t> window_;
  std::optional<int32_t> overlap_;
  std::optional<double> focal_;
  std::vector<double> principal_;
  std::vector<double> distortion_;
  std::string calibration_;
  bool rolling_ = false;
  std::optional<double> readout_ms_;
  std::vector<std::string> disabled_;
  bool every_frame_ = false;
  bool no_loop_ = false;
  bool batch_ = false;
  std::string model_;
  std::optional<int32_t> threads_;
  std::optional<int32_t> memory_mb_;
};

}  // namespace unisim::replay
