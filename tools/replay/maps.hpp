// SPDX-License-Identifier: MIT
// Maps that outlive the run: --load-map and --save-map.
#pragma once

#include <optional>
#include <string>

#include "drivers/mapfile/map_file.hpp"
#include "drivers/pipeline/pipeline.hpp"
#include "tools/replay/inputs.hpp"
#include "tools/replay/options.hpp"

namespace unisim::replay {

/// The map of --load-map, whose images have the size of the sequence's; without it nothing. And
/// where --save-map could not write, that is known now. Throws Failure.
std::optional<mapfile::MapFile> open_map(const Options& options);

/// Hands it to a pipeline that is prepared. Throws Failure (3).
void hand_over(mapfile::MapFile* map, pipeline::Pipeline* pipeline);

/// Saves the map of a run for --save-map. @return why there is no map, "" where there is one, or
/// none was asked for
std::string save_map(const Options& options, const pipeline::Pipeline& pipeline,
                     unisim_predictor* predictor);

}  // namespace unisim::replay
