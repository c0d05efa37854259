/* SPDX-License-Identifier: MIT */
/** @file source.h
 *  A source of frames: a recorded sequence or a camera. A table of functions, so that each reader
 *  and each camera driver is one file that knows nothing of the others. One source, one thread at a
 *  time, interrupt() excepted. */
#ifndef UNISIM_DRIVERS_SOURCE_H
#define UNISIM_DRIVERS_SOURCE_H

#include <stdint.h>

#include "drivers/image.h"
#include "unisim/unisim.h"

#ifdef __cplusplus
extern "C" {
#endif

/** One frame. */
typedef struct unisim_frame {
  int64_t index;        /**< position in the sequence, 0-based; gaps where frames were unreadable */
  int64_t timestamp_ns; /**< grows from frame to frame */
  unisim_image image;   /**< borrowed until the next call on the source */
} unisim_frame;

/** A ground-truth pose: camera-to-world, metres, scale 1. */
typedef struct unisim_stamped_pose {
  int64_t timestamp_ns;
  unisim_sim3 T_world_cam;
} unisim_stamped_pose;

#define UNISIM_FRAME_OK 0
#define UNISIM_FRAME_END 1 /**< no more frames */
/** This frame is unreadable: message() says why; the next call goes on. */
#define UNISIM_FRAME_BAD 2
/** The source is of no more use: message() says what, where, what to do. */
#define UNISIM_FRAME_FAILED 3

/** For next_frame(): as 1, but a frame whose pixels cannot be had is UNISIM_FRAME_OK with
 *  image.data NULL, and message() says why. A source may take it as 1. */
#define UNISIM_DECODE_IF_READABLE 2

/** A source. Free with destroy(source). */
typedef struct unisim_source unisim_source;
struct unisim_source {
  uint32_t
      struct_size;    /**< sizeof this struct, set by whoever fills it; a larger one is accepted */
  int32_t reserved;   /**< 0 */
  const char* format; /**< "tum", "7scenes", ...: static text */

  /** Frames in all, -1 if not known before the end. */
  int64_t (*frame_count)(unisim_source* source);

  /** Next frame.
   *  @param decode 1; 0: leave image.data NULL and save the time; UNISIM_DECODE_IF_READABLE
   *  @return UNISIM_FRAME_* */
  int (*next_frame)(unisim_source* source, int decode, unisim_frame* frame);

  /** Make a next_frame() that waits come back soon, and all later ones, with UNISIM_FRAME_END: the
   *  run is to end. From any thread at any time; optional, for sources that can wait for long. */
  void (*interrupt)(unisim_source* source);

  /** Ground truth the sequence carries.
   *  @param[out] poses owned by the source
   *  @return their number, 0 if none */
  int64_t (*ground_truth)(unisim_source* source, const unisim_stamped_pose** poses);

  /** Where the ground truth was read, "" if none. */
  const char* (*ground_truth_path)(unisim_source* source);

  /** One line about the last UNISIM_FRAME_BAD or _FAILED, or about pixels that are missing. */
  const char* (*message)(unisim_source* source);

  void (*destroy)(unisim_source* source);
};

#ifdef __cplusplus
}
#endif

#endif
