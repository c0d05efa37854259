// SPDX-License-Identifier: MIT
// Plain C values to core values and back.
#pragma once

#include "core/session.hpp"
#include "unisim/unisim.h"

namespace unisim {

inline unisim_status to_c(Status status) { return static_cast<unisim_status>(status); }

/// Prediction pose: finite, quaternion of length 1 within 1e-3 (made exact), scale 1 within 1e-9.
/// false: not that.
bool read_pose(const unisim_sim3& from, Sim3* to);
unisim_sim3 write_pose(const Sim3& from);

/// Pixels present and sizes plausible; what is in them is judged pixel by pixel. false: not that.
bool read_depth(const unisim_depth_map& from, DepthMap* to);

/// 0 (not known) or positive and finite.
bool is_sigma(double center_sigma);

/// Checked configuration. @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT, UNISIM_ERR_ABI_MISMATCH
unisim_status read_config(const unisim_config* from, SessionConfig* to);

}  // namespace unisim
