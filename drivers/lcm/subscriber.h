/* SPDX-License-Identifier: MIT */
/** @file subscriber.h
 *  Camera images that come over LCM (bot_core.image_t) as a source of frames.
 *
 *  Event logs are sequences: unisim_sequence_open() with format "lcm". */
#ifndef UNISIM_DRIVERS_LCM_SUBSCRIBER_H
#define UNISIM_DRIVERS_LCM_SUBSCRIBER_H

#include <stddef.h>
#include <stdint.h>

#include "drivers/lcm/problem.h"
#include "drivers/source.h"
#include "unisim/unisim.h"

#ifdef __cplusplus
extern "C" {
#endif

/** What to listen to. All zero but struct_size is a good default. */
typedef struct unisim_lcm_subscriber_config {
  uint32_t struct_size; /**< sizeof this struct, set by the caller */
  int32_t reserved;     /**< 0 */
  const char* url; /**< NULL or "": UNISIM_LCM_DEFAULT_URL; a receive buffer of 4 MB is asked for
                        unless it says recv_buf_size */
  const char* channel; /**< NULL or "": UNISIM_IMAGE */
} unisim_lcm_subscriber_config;

/** Listen to images. next_frame() waits for one that is newer than the last; what came while the
 *  caller was busy is passed over but for the newest. It ends with interrupt() only. The time of a
 *  frame is the utime of its image: one that is not after the last is UNISIM_FRAME_BAD, as an image
 *  that cannot be read is. A message of another type is UNISIM_FRAME_BAD once, then counted.
 *  @param[in]  config   copied; NULL: defaults
 *  @param[out] problem  UNISIM_LCM_*; may be NULL
 *  @param[out] message  one line on failure: what, where, what to do; may be NULL
 *  @param      capacity bytes of message
 *  @return NULL on failure; else free with its destroy() */
UNISIM_API unisim_source* unisim_lcm_subscribe(const unisim_lcm_subscriber_config* config,
                                               int32_t* problem, char* message, size_t capacity);

/** Things worth telling once: a receive buffer that large images do not fit.
 *  @param source of unisim_lcm_subscribe()
 *  @param i      0, 1, ...
 *  @return one line owned by the source, NULL past the last */
UNISIM_API const char* unisim_lcm_subscriber_note(const unisim_source* source, int32_t i);

/** Counters of a subscriber. */
typedef struct unisim_lcm_subscriber_counts {
  uint32_t struct_size; /**< sizeof this struct, set by the caller */
  int32_t reserved;     /**< 0 */
  int64_t received;     /**< images */
  int64_t passed_over;  /**< images that a newer one replaced before the caller came */
  int64_t foreign;      /**< messages of other types */
} unisim_lcm_subscriber_counts;

/** From any thread.
 *  @param source of unisim_lcm_subscribe()
 *  @param[out] counts filled as far as its struct_size reaches */
UNISIM_API void unisim_lcm_subscriber_get_counts(const unisim_source* source,
                                                 unisim_lcm_subscriber_counts* counts);

#ifdef __cplusplus
}
#endif

#endif
