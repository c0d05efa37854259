// SPDX-License-Identifier: MIT
// The map of a run as a file.
#pragma once

#include <string>

#include "drivers/mapfile/map_file.hpp"
#include "drivers/pipeline/pipeline.hpp"

namespace unisim::pipeline {

/// Writes the map of a run that has ended, see mapfile::save_map(). Throws mapfile::Error, also
/// where the run has left nothing to save.
/// @param about program and sequence  @param predictor of the pipeline
void save_map(const std::string& path, mapfile::About about, const Pipeline& pipeline,
              unisim_predictor* predictor);

}  // namespace unisim::pipeline
