// SPDX-License-Identifier: MIT
// The large messages: trajectory, points, images.
#include <algorithm>
#include <cstddef>

#include "drivers/lcm/publisher_state.hpp"
#include "unisim_image_t.h"
#include "unisim_points_t.h"
#include "unisim_trajectory_t.h"

using unisim::lcm::is_pose;
using unisim::lcm::microseconds;
using unisim::lcm::put;
using unisim::lcm::put_pose;

int unisim_lcm_publish_trajectory(unisim_lcm_publisher* publisher, int64_t timestamp_ns,
                                  int32_t map_revision, const unisim_pose* poses, int32_t count,
                                  int32_t chunk, int32_t chunks) {
  if (publisher == nullptr || poses == nullptr || count < 0 || count > UNISIM_LCM_CHUNK_POSES ||
      chunk < 0 || chunk >= chunks) {
    return UNISIM_LCM_REFUSED;
  }
  for (int32_t i = 0; i < count; ++i) {
    if (!is_pose(poses[i].T_world_kf)) return UNISIM_LCM_REFUSED;
    unisim_trajectory_pose_t& pose = publisher->poses[static_cast<size_t>(i)];
    pose.utime = microseconds(poses[i].timestamp_ns);
    pose.id = poses[i].keyframe_id;
    pose.segment = poses[i].segment;
    pose.confidence = poses[i].confidence;
    put_pose(poses[i].T_world_kf, pose.pos, pose.orientation);
    pose.scale = poses[i].T_world_kf.s;
  }
  unisim_trajectory_t out{};
  out.utime = microseconds(timestamp_ns);
  out.map_revision = map_revision;
  out.chunk = chunk;
  out.chunks = chunks;
  out.unit = publisher->unit;
  out.scale_sigma = publisher->scale_sigma;
  out.n = count;
  out.poses = publisher->poses.data();
  return put(publisher, "UNISIM_TRAJECTORY", out, unisim_trajectory_t_encoded_size,
             unisim_trajectory_t_encode);
}

int unisim_lcm_publish_points(unisim_lcm_publisher* publisher, const unisim_lcm_points* points) {
  if (publisher == nullptr || points == nullptr || points->struct_size < sizeof *points ||
      points->count < 0 || (points->count > 0 && points->xyz == nullptr) ||
      !is_pose(points->T_world_points)) {
    return UNISIM_LCM_REFUSED;
  }
  unisim_points_t out{};
  out.utime = microseconds(points->timestamp_ns);
  out.map_revision = points->map_revision;
  out.submap = points->submap_id;
  out.keyframe = points->keyframe_id;
  out.segment = points->segment;
  out.unit = publisher->unit;
  out.scale_sigma = publisher->scale_sigma;
  put_pose(points->T_world_points, out.pos, out.orientation);
  out.scale = points->T_world_points.s;
  constexpr int32_t kChunk = UNISIM_LCM_CHUNK_POINTS;
  out.chunks = std::max((points->count - 1) / kChunk + 1, 1);
  for (out.chunk = 0; out.chunk < out.chunks; ++out.chunk) {
    const int32_t first = out.chunk * kChunk;
    out.n = 3 * std::min(points->count - first, kChunk);
    // Encoding only reads the points.
    out.xyz = const_cast<float*>(points->xyz) + 3 * static_cast<ptrdiff_t>(first);
    put(publisher, "UNISIM_POINTS", out, unisim_points_t_encoded_size, unisim_points_t_encode);
  }
  return UNISIM_LCM_QUEUED;
}

int unisim_lcm_publish_image(unisim_lcm_publisher* publisher, int64_t timestamp_ns,
                             const unisim_image* image) {
  if (publisher == nullptr || image == nullptr || image->data == nullptr || image->width <= 0 ||
      image->height <= 0 || image->stride < image->width ||
      (image->format != UNISIM_PIXEL_GRAY8 && image->format != UNISIM_PIXEL_BGR8)) {
    return UNISIM_LCM_REFUSED;
  }
  const int64_t bytes = static_cast<int64_t>(image->stride) * image->height;
  if (bytes > LCM_MAX_MESSAGE_SIZE) return UNISIM_LCM_TOO_BIG;
  unisim_image_t out{};
  out.utime = microseconds(timestamp_ns);
  out.width = image->width;
  out.height = image->height;
  out.row_stride = image->stride;
  out.pixelformat = image->format == UNISIM_PIXEL_GRAY8 ? UNISIM_IMAGE_T_PIXEL_FORMAT_GRAY
                                                        : UNISIM_IMAGE_T_PIXEL_FORMAT_BGR;
  out.size = static_cast<int32_t>(bytes);
  out.data = const_cast<uint8_t*>(image->data);  // encoding only reads it
  return put(publisher, "UNISIM_IMAGE", out, unisim_image_t_encoded_size, unisim_image_t_encode);
}
