// SPDX-License-Identifier: MIT
// A predictor whose every answer follows from the numbers asked for, late and rejected ones too.
#pragma once

#include "drivers/predictor.h"

namespace unisim::test {

/// Frames are 0, 1, 2 ...; frame 5 is of no use; pairs are pending until keyframe 2; pair 4,5 and
/// windows that end at keyframe 7 are rejected; each window is revised two keyframes later.
/// Free with destroy().
unisim_predictor* make_scripted_predictor();

constexpr int kScriptedDepthWidth = 5;  // odd, so that the padding of records is exercised
constexpr int kScriptedDepthHeight = 3;

}  // namespace unisim::test
