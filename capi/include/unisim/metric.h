/* SPDX-License-Identifier: MIT */
/** @file metric.h
 *  Metric scale: what is known of lengths in metres, and how long a metre is on the map; included
 *  by unisim.h.
 *
 *  One camera alone does not see scale. A host that knows distances says them; poses stay in the
 *  map's own unit, so that nothing jumps when one comes, and unisim_get_scale() says how many
 *  metres that unit has. Submaps whose units disagree with the distances are drawn back by the next
 *  unisim_optimize(): scale that drifts is corrected, and that is reported as any other correction.
 *  What is measured belongs to submaps: it counts from the unisim_optimize() after a submap over
 *  the keyframes has come, and goes along when they retire, merge or join another segment. */
#ifndef UNISIM_METRIC_H
#define UNISIM_METRIC_H

#include "unisim/config.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Where a measurement comes from. */
#define UNISIM_METRIC_DISTANCE 0 /**< two places whose distance is known */
#define UNISIM_METRIC_ODOMETRY 1 /**< wheels, legs, inertial navigation */
#define UNISIM_METRIC_HEIGHT 2   /**< height of the camera over the ground */
#define UNISIM_METRIC_MODEL 3    /**< a predictor that says lengths in metres */

/** A distance between the camera centres of two keyframes: the chord, not the path. */
typedef struct unisim_distance {
  uint32_t struct_size; /**< sizeof this struct, set by the caller */
  int32_t i;            /**< keyframe */
  int32_t j;            /**< another keyframe */
  int32_t source;       /**< UNISIM_METRIC_* */
  double metres;        /**< > 0 */
  double sigma;         /**< its standard deviation in metres, apart from common_sigma; at least a
                             millionth of metres and at most all of it */
  double common_sigma;  /**< relative error that all measurements of this source share (a wheel that
                             is smaller than said), 0..1: no number of them makes the scale surer.
                             The largest that was given counts */
} unisim_distance;

/** Add a distance between two keyframes that are kept. It is compared with the others nearby: one
 *  that is far off, a wheel's slip, does not count. Up to 256 wait for a submap over both keyframes
 *  or for the submaps between; beyond, the oldest is lost.
 *  @param session live session
 *  @param[in] distance see unisim_distance; best a good part of a window apart, shorter than a
 *                      twentieth of its extent it says nothing
 *  @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT (numbers out of range, unknown or equal
 *          keyframes), UNISIM_ERR_RETIRED (a keyframe is no longer kept), UNISIM_ERR_ABI_MISMATCH
 */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_add_distance(unisim_session* session,
                                                              const unisim_distance* distance);

/** How long the unit of a submap's prediction is. */
typedef struct unisim_submap_unit {
  uint32_t struct_size; /**< sizeof this struct, set by the caller */
  int32_t submap_id;    /**< as unisim_add_submap() gave it, of a window */
  int32_t source;       /**< UNISIM_METRIC_* */
  int32_t reserved;     /**< 0 */
  double metres;        /**< in one unit of the poses and depth handed in last, 1e-9..1e9 */
  double sigma;         /**< relative standard deviation, apart from common_sigma; 1e-6..1 */
  double common_sigma;  /**< as in unisim_distance */
} unisim_submap_unit;

/** Say how long the unit of a submap is.
 *  @param session live session
 *  @param[in] unit see unisim_submap_unit
 *  @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT (numbers out of range, not a window's submap),
 *          UNISIM_ERR_RETIRED (no longer kept), UNISIM_ERR_ABI_MISMATCH */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_add_submap_unit(unisim_session* session,
                                                                 const unisim_submap_unit* unit);

/** How long a metre is on the map. */
typedef struct unisim_scale {
  uint32_t struct_size;   /**< sizeof this struct, set by the caller */
  int32_t segment;        /**< as in unisim_pose */
  double metres_per_unit; /**< metres in one length of the segment's poses */
  double sigma;           /**< its relative standard deviation, common_sigma included */
  int32_t taken;          /**< distances that count, of all segments */
  int32_t refused;        /**< far from the others, or too short to tell */
  int32_t waiting;        /**< no submap over them has come */
  int32_t lost;           /**< their keyframes left before one came */
} unisim_scale;

/** The scale of a segment. Its standard deviation is made anew when nothing has come since the last
 *  unisim_optimize(), else it is that of the last call; making it costs as unisim_get_covariance()
 *  of one keyframe, and later poses differ in their last digits likewise.
 *  @param session live session
 *  @param segment as in unisim_pose
 *  @param[out] scale filled on success
 *  @return UNISIM_OK, UNISIM_ERR_NOT_READY (relative: nothing is known of its metre, or not yet how
 *          surely), UNISIM_ERR_NUMERICAL, UNISIM_ERR_INVALID_ARGUMENT, UNISIM_ERR_ABI_MISMATCH */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_get_scale(unisim_session* session, int32_t segment,
                                                           unisim_scale* scale);

#ifdef __cplusplus
}
#endif

#endif
