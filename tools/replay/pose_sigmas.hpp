// SPDX-License-Identifier: MIT
// How far keyframe poses may be off when their segment is laid over the truth.
#pragma once

#include <vector>

#include "unisim/unisim.h"

namespace unisim::replay {

/// Standard deviations of a pose; below 0: not known.
struct PoseSigma {
  double position = -1.0;  ///< of the map's unit, all three directions together
  double rotation = -1.0;  ///< rad, about all three axes together
};

/// unisim_get_covariance() is relative to the first keyframe of a segment: it is zero there and
/// grows with the distance. An error that is seen after an alignment is not: the alignment spreads
/// it over all keyframes. So the same freedom is taken out of the covariance here, the similarity
/// that lays the positions of a segment's keyframes best over each other (least squares, as
/// unisim-eval aligns): with d the errors of all poses, A d what the alignment takes of them and
/// D_i how that moves pose i, what is left is d_i - D_i A d, whose covariance needs the joint one
/// of d, a few products of it. The mean of the rotations that are left goes too: where the axis of
/// a camera is, its principal point says, which nobody knows to a pixel.
/// @param poses of the session, in the order of their keyframes; those of fewer than three posed
///        keyframes of a segment, and those no longer kept, are not known
std::vector<PoseSigma> pose_sigmas(unisim_session* session, const std::vector<unisim_pose>& poses);

}  // namespace unisim::replay
