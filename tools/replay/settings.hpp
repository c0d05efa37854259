// SPDX-License-Identifier: MIT
// The configuration of a run: every field can be set in a TOML file.
#pragma once

#include <string>

#include "drivers/geometric/geometric.h"
#include "drivers/onnx/onnx.h"
#include "drivers/pipeline/pipeline.hpp"
#include "unisim/unisim.h"

namespace unisim::replay {

/// What `--config` may set: sections [session], [pipeline], [geometric], [onnx], keys as the
/// fields.
struct Settings {
  unisim_config session;
  unisim_geometric_config geometric;
  unisim_onnx_config onnx;  ///< its strings stay NULL: they are Options
  pipeline::Options pipeline;
  bool window_size_given = false;     ///< else a recording says
  bool window_overlap_given = false;  ///< else it follows from the predictor
  bool max_keyframes_given = false;   ///< else a batch takes the length of the sequence
};

Settings default_settings();

/// Changes what the file names. Throws Failure: no such file (3), or (2) a folder, a syntax error,
/// an unknown section or key, with the nearest known one, a value of the wrong type or range; with
/// file, line and field.
void load_settings(const std::string& path, Settings* settings);

/// Least session.max_keyframes that the other fields allow.
int32_t least_keyframes(const unisim_config& session);

/// Ranges that depend on other fields. Throws Failure (2) that names them.
void check_together(const Settings& settings);

/// All fields as a file that load_settings() reads.
std::string settings_text(const Settings& settings);

}  // namespace unisim::replay
