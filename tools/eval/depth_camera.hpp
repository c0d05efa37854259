// SPDX-License-Identifier: MIT
// The camera of depth images, as recordings spell it.
#pragma once

#include <string>

#include "tools/eval/depth_images.hpp"

namespace unisim::eval {

/// Looks in the folder and the one above it: camera.toml of unisim-synth, cam_params.json of
/// Replica (which tells the unit too), *intrinsics*.txt with a 3x3 matrix. 7-Scenes without any has
/// its usual camera. Sets camera, camera_from and where the file tells it units_per_metre.
/// @throws InputError when there is none, or its numbers are none
void find_depth_camera(const std::string& folder, DepthImages* found);

}  // namespace unisim::eval
