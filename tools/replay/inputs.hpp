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

struct FrameSize {
  int32_t width = 0;
  int32_t height = 0;
};

/// Of the sequence's first readable frame. Nothing where there is none, as the run itself will say,
/// or where the frames are those of a live camera.
std::optional<FrameSize> frame_size(const Options& options);

/// The predictor asked for, inside a recorder where --record asks for one. Throws Failure.
/// @param[in,out] settings its windows are fitted to what the predictor can give
/// @param[out]    notes    lines worth telling
PredictorPtr open_predictor(const Options& options, Settings* settings,
                            std::vector<std::string>* notes);

/// Why recording stopped, "" while all is well or nothing is recorded.
std::string recorder_problem(const Options& options, const unisim_predictor* predictor);

}  // namespace unisim::replay
