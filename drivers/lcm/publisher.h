/* SPDX-License-Identifier: MIT */
/** @file publisher.h
 *  Sends poses, keyframes, corrections and the rest over LCM: the channels and messages of
 *  messages/, explained in README.md.
 *
 *  A call encodes its message into a queue of fixed size and returns; a thread of the publisher
 *  hands it to the network. A slow or absent network never holds the caller: when the queue is full
 *  the oldest messages are dropped and counted. After unisim_lcm_publisher_create() a call takes no
 *  memory from the heap. One publisher, one thread at a time.
 *
 *  Time stamps are those of the frames; on the wire they are microseconds, rounded down. */
#ifndef UNISIM_DRIVERS_LCM_PUBLISHER_H
#define UNISIM_DRIVERS_LCM_PUBLISHER_H

#include <stddef.h>
#include <stdint.h>

#include "drivers/lcm/problem.h"
#include "drivers/source.h"
#include "unisim/unisim.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Unit of all lengths that are sent; the numbers of status_t.UNIT_*. */
#define UNISIM_LCM_UNIT_RELATIVE 0 /**< the map's own */
#define UNISIM_LCM_UNIT_METRIC 1   /**< metres */

/** What unisim_lcm_publish_*() answers. */
#define UNISIM_LCM_QUEUED 0  /**< on its way */
#define UNISIM_LCM_REFUSED 1 /**< NULL, not finite, a scale or count that makes no sense */
#define UNISIM_LCM_TOO_BIG 2 /**< larger than half of queue_bytes */

/** How to make a publisher. All zero but struct_size is a good default. */
typedef struct unisim_lcm_publisher_config {
  uint32_t struct_size; /**< sizeof this struct, set by the caller */
  int32_t unit;         /**< UNISIM_LCM_UNIT_* of the lengths that are sent until
                             unisim_lcm_publisher_set_unit() says otherwise (0) */
  int32_t queue_bytes; /**< messages that may wait; twice the largest image to be sent, and 64 kB to
                            1 GB; 0: 4 MB (0) */
  int32_t requests;    /**< 1: listen to UNISIM_REQUEST, for unisim_lcm_next_request() (0) */
  const char* url;     /**< NULL or "": UNISIM_LCM_DEFAULT_URL. "file://PATH?mode=w" writes an LCM
                            event log */
} unisim_lcm_publisher_config;

/** A publisher. */
typedef struct unisim_lcm_publisher unisim_lcm_publisher;

/** Open the network and start the thread that sends.
 *  @param[in]  config   copied; NULL: defaults
 *  @param[out] problem  UNISIM_LCM_*; may be NULL
 *  @param[out] message  one line on failure: what, where, what to do; may be NULL
 *  @param      capacity bytes of message
 *  @return NULL on failure */
UNISIM_API unisim_lcm_publisher* unisim_lcm_publisher_create(
    const unisim_lcm_publisher_config* config, int32_t* problem, char* message, size_t capacity);

/** Give what is queued up to a second to go out, end the thread. NULL is fine. */
UNISIM_API void unisim_lcm_publisher_destroy(unisim_lcm_publisher* publisher);

/** Wait up to a second for what is queued to go out: before the counters are read at the end.
 *  @param publisher live publisher */
UNISIM_API void unisim_lcm_publisher_flush(unisim_lcm_publisher* publisher);

/** Say the unit of the lengths that are sent from now on. Poses go on in the new one after a
 *  correction whose jump scales them; send a status then too.
 *  @param publisher live publisher
 *  @param unit        UNISIM_LCM_UNIT_*
 *  @param scale_sigma of METRIC: relative standard deviation of the metre; else 0
 *  @return UNISIM_LCM_QUEUED, _REFUSED */
UNISIM_API int unisim_lcm_publisher_set_unit(unisim_lcm_publisher* publisher, int32_t unit,
                                             double scale_sigma);

/** UNISIM_POSE: the pose of a frame as it is known first.
 *  @param publisher live publisher
 *  @param timestamp_ns of the frame
 *  @param[in] T_world_cam its scale is not sent
 *  @return UNISIM_LCM_QUEUED, _REFUSED */
UNISIM_API int unisim_lcm_publish_pose(unisim_lcm_publisher* publisher, int64_t timestamp_ns,
                                       const unisim_sim3* T_world_cam);

/** UNISIM_KEYFRAME.
 *  @param publisher live publisher
 *  @param[in] pose as unisim_get_pose() gives it
 *  @param map_revision as unisim_get_info() gives it
 *  @param[in] covariance 49 values as unisim_get_covariance() gives them; NULL: not known
 *  @return UNISIM_LCM_QUEUED, _REFUSED */
UNISIM_API int unisim_lcm_publish_keyframe(unisim_lcm_publisher* publisher, const unisim_pose* pose,
                                           int32_t map_revision, const double covariance[49]);

/** What unisim_lcm_publish_correction() says. */
typedef struct unisim_lcm_correction {
  uint32_t struct_size;  /**< sizeof this struct, set by the caller */
  int32_t map_revision;  /**< after the optimisation */
  int64_t timestamp_ns;  /**< of the newest pose sent before it */
  int32_t keyframe_id;   /**< the newest posed one */
  int32_t segment;       /**< of that keyframe */
  int32_t first_changed; /**< see unisim_report */
  int32_t last_changed;
  unisim_sim3 T_new_old; /**< world before to world after: T_new_old * pose before = pose now */
} unisim_lcm_correction;

/** UNISIM_CORRECTION.
 *  @param publisher live publisher
 *  @param[in] correction see unisim_lcm_correction
 *  @return UNISIM_LCM_QUEUED, _REFUSED */
UNISIM_API int unisim_lcm_publish_correction(unisim_lcm_publisher* publisher,
                                             const unisim_lcm_correction* correction);

/** Keyframes in one message of UNISIM_TRAJECTORY. */
#define UNISIM_LCM_CHUNK_POSES 512

/** One message of UNISIM_TRAJECTORY.
 *  @param publisher live publisher
 *  @param timestamp_ns of the newest frame
 *  @param map_revision of the poses
 *  @param[in] poses ascending ids
 *  @param count 0..UNISIM_LCM_CHUNK_POSES
 *  @param chunk, chunks which of how many messages
 *  @return UNISIM_LCM_QUEUED, _REFUSED */
UNISIM_API int unisim_lcm_publish_trajectory(unisim_lcm_publisher* publisher, int64_t timestamp_ns,
                                             int32_t map_revision, const unisim_pose* poses,
                                             int32_t count, int32_t chunk, int32_t chunks);

/** Stages in a status. */
#define UNISIM_LCM_MAX_STAGES 16

/** How long one stage of the computation takes. */
typedef struct unisim_lcm_stage {
  const char* name; /**< zero-ended, at most 63 bytes */
  int64_t count;
  double p50_ms;
  double p95_ms;
  double max_ms;
} unisim_lcm_stage;

/** What unisim_lcm_publish_status() says. */
typedef struct unisim_lcm_status {
  uint32_t struct_size; /**< sizeof this struct, set by the caller */
  int32_t state;        /**< UNISIM_STATE_* */
  int64_t timestamp_ns; /**< of the newest frame */
  int32_t confidence;   /**< of the newest posed keyframe, see unisim_pose */
  int32_t keyframe_id;  /**< the newest posed one, -1 if none */
  int32_t segment;      /**< of it, -1 if none */
  int32_t map_revision;
  int64_t frames;         /**< seen */
  int64_t frames_bad;     /**< unreadable */
  int64_t frames_dropped; /**< late */
  int32_t queue_depth;    /**< frames that wait to be seen */
  int32_t keyframes;
  int32_t submaps;
  int32_t loops;
  int32_t lost_events;
  int32_t stage_count;            /**< 0..UNISIM_LCM_MAX_STAGES */
  const unisim_lcm_stage* stages; /**< stage_count, read during the call */
  int32_t reason;   /**< UNISIM_REASON_* of predictor.h: why the state is what it is; 0: none */
  int32_t reserved; /**< 0 */
} unisim_lcm_status;

/** UNISIM_STATUS; the unit and the messages dropped are added.
 *  @param publisher live publisher
 *  @param[in] status see unisim_lcm_status
 *  @return UNISIM_LCM_QUEUED, _REFUSED */
UNISIM_API int unisim_lcm_publish_status(unisim_lcm_publisher* publisher,
                                         const unisim_lcm_status* status);

/** Points in one message of UNISIM_POINTS. */
#define UNISIM_LCM_CHUNK_POINTS 4096

/** Points of a submap. */
typedef struct unisim_lcm_points {
  uint32_t struct_size; /**< sizeof this struct, set by the caller */
  int32_t submap_id;
  int64_t timestamp_ns;       /**< of the keyframe */
  int32_t map_revision;       /**< of T_world_points */
  int32_t segment;            /**< of the keyframe */
  unisim_sim3 T_world_points; /**< rotation and translation of the keyframe, unit of the points */
  const float* xyz; /**< 3 count values in the camera frame of the keyframe, read during the call */
  int32_t count;    /**< any; more than UNISIM_LCM_CHUNK_POINTS go in several messages */
  int32_t keyframe_id;
} unisim_lcm_points;

/** UNISIM_POINTS.
 *  @param publisher live publisher
 *  @param[in] points see unisim_lcm_points
 *  @return UNISIM_LCM_QUEUED, _REFUSED */
UNISIM_API int unisim_lcm_publish_points(unisim_lcm_publisher* publisher,
                                         const unisim_lcm_points* points);

/** UNISIM_IMAGE, as PIXEL_FORMAT_GRAY or _BGR.
 *  @param publisher live publisher
 *  @param timestamp_ns of the frame
 *  @param[in] image pixels are read during the call
 *  @return UNISIM_LCM_QUEUED, _REFUSED, _TOO_BIG */
UNISIM_API int unisim_lcm_publish_image(unisim_lcm_publisher* publisher, int64_t timestamp_ns,
                                        const unisim_image* image);

/** Take a request for the trajectory (unisim_lcm_publisher_config.requests). Never waits.
 *  @param publisher live publisher
 *  @param[out] first_id oldest keyframe wanted
 *  @return 1; 0 when there is none */
UNISIM_API int unisim_lcm_next_request(unisim_lcm_publisher* publisher, int32_t* first_id);

/** Counters of a publisher. */
typedef struct unisim_lcm_publisher_counts {
  uint32_t struct_size; /**< sizeof this struct, set by the caller */
  int32_t error_number; /**< errno of the last failure, 0 if none */
  int64_t queued;       /**< taken */
  int64_t sent;         /**< handed to the network */
  int64_t dropped;      /**< by the queue */
  int64_t failed;       /**< refused by the network */
  int64_t foreign;      /**< messages on UNISIM_REQUEST that are none */
} unisim_lcm_publisher_counts;

/** @param publisher live publisher
 *  @param[out] counts filled as far as its struct_size reaches */
UNISIM_API void unisim_lcm_publisher_get_counts(const unisim_lcm_publisher* publisher,
                                                unisim_lcm_publisher_counts* counts);

#ifdef __cplusplus
}
#endif

#endif
