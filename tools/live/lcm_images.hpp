// SPDX-License-Identifier: MIT
// Images that another program sends over LCM, as the camera of a live run.
#pragma once

#include <cstdint>
#include <string>

#include "tools/live/options.hpp"
#include "tools/replay/run.hpp"

namespace unisim::live {

/// "lcm://" is LCM's own udpm at the usual address, "", "lcm://ADDRESS:PORT?..." at another.
std::string udpm_url(const std::string& device);

/// @param problem UNISIM_LCM_*
int exit_code_of_lcm(int32_t problem);

/// Listens. Throws Failure: a wrong URL, or not in this build (2); no network (4).
replay::Input open_lcm_images(const Options& options);

/// Messages that were no image, and images that newer ones replaced, "" when there were none.
/// @param source of open_lcm_images()
std::string lcm_losses(const unisim_source* source);

}  // namespace unisim::live
