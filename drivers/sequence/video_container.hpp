// SPDX-License-Identifier: MIT
// What a video file says of itself that OpenCV does not hand on.
#pragma once

#include <string>

namespace unisim::sequence {

struct ContainerFacts {
  /// The file has fewer bytes than its parts announce.
  bool cut_off = false;
  /// The frames it counts are those it shows. Not so with a list of edits that hides some (a part
  /// cut out without encoding again), and in containers whose count is an estimate.
  bool counts_shown_frames = false;
};

/// Reads MP4 and MOV, AVI, Matroska and WebM; of others nothing is known.
ContainerFacts read_container(const std::string& path);

}  // namespace unisim::sequence
