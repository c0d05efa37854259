// SPDX-License-Identifier: MIT
// Trajectories and the keyframe table as text.
#pragma once

#include <string>
#include <vector>

#include "drivers/pipeline/temporary_file.hpp"
#include "drivers/predictor.h"
#include "tools/replay/run_data.hpp"

namespace unisim::replay {

/// Comments at the head of a trajectory.
/// @param title what the poses are
/// @param scale metres per unit found by alignment with ground truth, <= 0: not known
/// @param known what the lengths, which are metres then, were in the map; NULL: they are in its
/// unit
std::string trajectory_header(const std::string& title, double scale,
                              const SegmentScale* known = nullptr);

/// One pose in TUM format.
std::string trajectory_line(const unisim_stamped_pose& pose);

/// TUM format: timestamp [s] tx ty tz qx qy qz qw, camera-to-world, comments first.
std::string trajectory_text(const std::string& title, const std::vector<unisim_stamped_pose>& poses,
                            double scale, const SegmentScale* known = nullptr);

/// CSV: one line per keyframe that has a pose.
std::string keyframe_table(const RunData& data);

/// CSV: one line per older keyframe that a keyframe was compared with, and what came of it.
/// @param told those whose verdict stood while the run went on
/// @param info of its end
std::string place_table(const pipeline::RecordFile<unisim_place_report>& told,
                        const unisim_predictor_info& info);

}  // namespace unisim::replay
