// SPDX-License-Identifier: MIT
// Opens what a run works with: the sequence and the predictor.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/common/owned.hpp"
#include "tools/replay/options.hpp"

namespace unisim::replay {

using drivers::PredictorPtr;
using drivers::SourcePtr;

/// Throws Failure (3).
/// @param[out] notes lines worth telling
SourcePtr open_sequence(const Options& options, std::vector<std::string>* notes);

/// Of the sequence's first readable frame, or what a live camera has said. Nothing where there is
/// none, as the run itself will say.
std::optional<FrameSize> frame_size(const Options& options);

/// The predictor asked for, inside a recorder where --record asks for one. Throws Failure.
/// @param[in,out] settings its windows are fitted to what the predictor can give
/// @param[out]    notes    lines worth telling
PredictorPtr open_predictor(const Options& options, Settings* settings,
                            std::vector<std::string>* notes);

/// Why recording stopped, "" while all is well or nothing is recorded.
std::string recorder_problem(const Options& options, const unisim_predictor* predictor);

}  // namespace unisim::replay
