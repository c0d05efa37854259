/* SPDX-License-Identifier: MIT */
/** @file results.h
 *  Results out, by copy: poses, what has left the window, loops, submaps, counters; included by
 *  unisim.h. */
#ifndef UNISIM_RESULTS_H
#define UNISIM_RESULTS_H

#include "unisim/config.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Tracking state. */
#define UNISIM_STATE_INIT 0     /**< no pose yet */
#define UNISIM_STATE_TRACKING 1 /**< the newest pair was accepted */
#define UNISIM_STATE_DEGRADED 2 /**< it was rejected, the pose is held; or its scale is a guess */
#define UNISIM_STATE_LOST 3     /**< lost_after pairs in a row were rejected */
#define UNISIM_STATE_RELOCALISED 4 /**< a loop has joined the segments after a loss */

/** Pose of a keyframe. */
typedef struct unisim_pose {
  uint32_t struct_size;   /**< sizeof this struct, set by the caller */
  int32_t keyframe_id;    /**< as unisim_add_keyframe() gave it */
  int64_t timestamp_ns;   /**< of the keyframe */
  unisim_sim3 T_world_kf; /**< scale: unit of the keyframe's two-view prediction to the world */
  int32_t state;          /**< UNISIM_STATE_* when the keyframe was taken */
  int32_t confidence;     /**< 0 held or unknown, 1 pair only, 2 in a submap, 3 in two or a loop */
  int32_t submap_id;      /**< submap that covers it best, -1 if none */
  int32_t segment;        /**< keyframes of different segments have no common frame or scale */
} unisim_pose;

/** Latest pose of one keyframe.
 *  @param session live session
 *  @param keyframe_id as unisim_add_keyframe() gave it
 *  @param[out] pose filled on success
 *  @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT, UNISIM_ERR_NOT_READY (no pose yet),
 *          UNISIM_ERR_RETIRED (older than the newest max_keyframes: unisim_next_retired()) */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_get_pose(const unisim_session* session,
                                                          int32_t keyframe_id, unisim_pose* pose);

/** Latest poses of all keyframes that are kept and have one, ascending.
 *  @param session live session
 *  @param[out] poses    caller's array; poses[0].struct_size set by the caller, it counts for all
 *  @param      capacity its length
 *  @param[out] count    poses written; the needed number on UNISIM_ERR_CAPACITY
 *  @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT, UNISIM_ERR_CAPACITY */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_get_trajectory(const unisim_session* session,
                                                                unisim_pose* poses, size_t capacity,
                                                                size_t* count);

/** Marginal covariance of a keyframe pose (7x7, column-major, tangent order), from the last
 *  unisim_optimize(), times its variance of unit weight: 2 cost / degrees of freedom, or what the
 *  center_sigma of its windows says where that is more (unisim_config.sigma_factor). Zero for the
 *  first keyframe of a segment, which is held. Behind a sliding window it is that of the submap
 *  that carries the keyframe (zero for the first submap) and of the keyframe in it. Cost: one
 *  factorisation for the first keyframe asked for, then for each what of the inverse it needs and
 *  those before it did not: all keyframes together take about twice as long as the newest one. The
 *  system is built anew at the present poses for it, so the poses of later optimisations differ in
 *  their last digits (about 1e-8) from those of a session that was not asked.
 *  @param session live session
 *  @param keyframe_id as unisim_add_keyframe() gave it
 *  @param[out] covariance 49 values, column-major
 *  @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT, UNISIM_ERR_NOT_READY when the graph has
 *          changed since or the pose is held, UNISIM_ERR_NUMERICAL, UNISIM_ERR_RETIRED */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_get_covariance(unisim_session* session,
                                                                int32_t keyframe_id,
                                                                double covariance[49]);

/** The joint covariance of the poses of several keyframes times a vector: how errors of different
 *  poses go together, which unisim_get_covariance() does not say. With a single 1 among the weights
 *  the products are a column of the joint covariance; with weights w_i they are the covariances of
 *  the sum of w_i' d_i with each d_i, where d_i is the error of pose i (tangent order), so that
 *  what is known of a relative pose, or of what an alignment leaves, follows from a few products.
 *  In the frame and scaled as unisim_get_covariance() does it. Keyframes that are held by the gauge
 *  or have no pose of their own take no part: their products are 0. Cost: one factorisation for the
 *  first product, then one solution of a factorised system for each.
 *  @param session live session
 *  @param first_keyframe, count these keyframes
 *  @param[in] weights   7 for each keyframe
 *  @param[out] products 7 for each keyframe; may not overlap weights
 *  @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT (a keyframe that is not there),
 *          UNISIM_ERR_RETIRED, UNISIM_ERR_NOT_READY when the graph has changed since,
 *          UNISIM_ERR_NUMERICAL */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_multiply_covariance(unisim_session* session,
                                                                     int32_t first_keyframe,
                                                                     int32_t count,
                                                                     const double* weights,
                                                                     double* products);

/** Kinds of unisim_retired. */
#define UNISIM_RETIRED_KEYFRAME 0 /**< a keyframe, rigid in a submap from now on */
#define UNISIM_RETIRED_SUBMAP 1   /**< a submap, rigid in another one from now on */

/** What has left the sliding window. The pose of a keyframe is for ever
 *  T_world_submap * T_submap_kf, with the pose unisim_get_submap() gives for its submap at that
 *  time. When neighbours of the skeleton merge, one of them is rigid in the other from then on:
 *  T_world_submap = T_world_anchor * T_anchor_submap. A host that keeps both kinds finds every
 *  pose by following anchors, also of keyframes and submaps that the session keeps no longer. */
typedef struct unisim_retired {
  uint32_t struct_size; /**< sizeof this struct, set by the caller */
  int32_t kind;         /**< UNISIM_RETIRED_* */
  int32_t keyframe_id;  /**< -1 for a submap */
  int32_t submap_id;    /**< that carries the keyframe, or that has become rigid */
  int32_t anchor_id;    /**< submap that carries the submap, -1 for a keyframe */
  int32_t confidence;   /**< as in unisim_pose, 0 for a submap */
  int32_t segment;      /**< as in unisim_pose */
  int32_t reserved;     /**< 0 */
  int64_t timestamp_ns; /**< of the keyframe, 0 for a submap */
  unisim_sim3 T;        /**< T_submap_kf or T_anchor_submap, scale included */
} unisim_retired;

/** Take what has left the window since the last call, each once: keyframes in order, then submaps.
 *  Call it until it says UNISIM_ERR_NOT_READY, after each unisim_add_submap(). What is not asked
 *  for before it makes room is lost: unisim_session_info.retired_unread counts it.
 *  @param session live session
 *  @param[out] retired filled on success
 *  @return UNISIM_OK, UNISIM_ERR_NOT_READY when there is nothing new, UNISIM_ERR_INVALID_ARGUMENT
 */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_next_retired(unisim_session* session,
                                                              unisim_retired* retired);

/** States of a loop. */
#define UNISIM_LOOP_ACTIVE 0    /**< holds the map, as far as its robust weight lets it */
#define UNISIM_LOOP_SUSPENDED 1 /**< does not agree with the map; tried again later */
#define UNISIM_LOOP_RIGID 2     /**< both its places have become one */
#define UNISIM_LOOP_REMOVED 3   /**< by unisim_remove_loop(), or dropped to stay within memory */

/** How a loop stands. */
typedef struct unisim_loop_info {
  uint32_t struct_size; /**< sizeof this struct, set by the caller */
  int32_t submap_id;    /**< as unisim_add_loop() gave it */
  int32_t state;        /**< UNISIM_LOOP_* */
  int32_t condensed; /**< 1: its keyframes have left the window, it is one edge; loops between the
                          same places that agree share one */
  double residual;   /**< whitened, after the last unisim_optimize(); good ones are near 0.01 */
} unisim_loop_info;

/** How a loop stands. A loop whose residual stays beyond unisim_config.loop_gate for five
 *  optimisations is suspended: it no longer pulls. After ten optimisations, then twice as many, its
 *  residual on the map as it is then decides whether it is back. The log says each with its reason,
 *  unisim_get_info() counts them.
 *  @param session live session
 *  @param submap_id as unisim_add_loop() gave it
 *  @param[out] info filled on success
 *  @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT (not a loop), UNISIM_ERR_RETIRED */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_get_loop(const unisim_session* session,
                                                          int32_t submap_id,
                                                          unisim_loop_info* info);

/** Take a loop back: it no longer holds the map. Poses stay where they are until the next
 *  unisim_optimize(). Loops that have been fused with it into one edge go with it, they cannot be
 *  told apart any more.
 *  @param session live session
 *  @param submap_id as unisim_add_loop() gave it
 *  @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT (not a loop, removed before), UNISIM_ERR_RETIRED
 *          (too old to be known by its id) */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_remove_loop(unisim_session* session,
                                                             int32_t submap_id);

/** A submap as the graph holds it. */
typedef struct unisim_submap_info {
  uint32_t struct_size;                   /**< sizeof this struct, set by the caller */
  int32_t submap_id;                      /**< as unisim_add_submap() gave it */
  int32_t is_loop;                        /**< 1: from unisim_add_loop() */
  int32_t count;                          /**< views */
  int32_t keyframe_ids[UNISIM_MAX_VIEWS]; /**< ascending */
  unisim_sim3 T_world_submap;             /**< submap unit to the world */
  double center_sigma;                    /**< as handed in last */
  double scatter; /**< median absolute deviation of the log depth ratios to the two-view depths */
} unisim_submap_info;

/** Latest pose and keyframes of a submap.
 *  @param session live session
 *  @param submap_id as unisim_add_submap() gave it
 *  @param[out] info filled on success
 *  @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT, UNISIM_ERR_RETIRED (no longer kept) */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_get_submap(const unisim_session* session,
                                                            int32_t submap_id,
                                                            unisim_submap_info* info);

/** Why a prediction was refused. */
#define UNISIM_REFUSED_NONE 0    /**< none has been */
#define UNISIM_REFUSED_SIGMA 1   /**< center_sigma over sigma_gate or sigma_gate_loop */
#define UNISIM_REFUSED_SCATTER 2 /**< depth ratios scatter by more than scatter_gate */
#define UNISIM_REFUSED_VIEWS 3   /**< fewer than two views have depth in common with the map */
#define UNISIM_REFUSED_RANGE 4   /**< its unit is out of the range of numbers */
#define UNISIM_REFUSED_HOST 5    /**< unisim_reject_request() */
#define UNISIM_REFUSED_ROOM 6    /**< too many windows are open, or max_submaps are cut */
#define UNISIM_REFUSED_LATE 7    /**< it did not come before its keyframes left the window */

/** A prediction that was refused. When a counter of unisim_session_info has grown over a call, this
 *  says which one it was and why. */
typedef struct unisim_refusal {
  int32_t reason;         /**< UNISIM_REFUSED_* */
  int32_t first_keyframe; /**< of the prediction, -1 if none */
  int32_t last_keyframe;  /**< -1 if none */
  int32_t reserved;       /**< 0 */
  double value;           /**< what was beyond the limit; 0 where the reason has no limit */
  double limit;           /**< the gate; 0 where the reason has none */
} unisim_refusal;

/** Where the session stands. Counters that nothing bounds stay at the largest number. */
typedef struct unisim_session_info {
  uint32_t struct_size;          /**< sizeof this struct, set by the caller */
  int32_t state;                 /**< UNISIM_STATE_* now */
  int32_t keyframes;             /**< added */
  int32_t posed_keyframes;       /**< with a pose that a prediction supports */
  int32_t last_posed;            /**< newest keyframe with a pose, -1 if none: the live pose */
  int32_t submaps;               /**< in the graph, loops not counted */
  int32_t submaps_refused;       /**< windows of UNISIM_REFUSED_* kinds, updates included */
  int32_t loops;                 /**< loop submaps in the graph */
  int32_t loops_refused;         /**< the same of loops */
  int32_t pairs_refused;         /**< the same of pairs */
  int32_t segments;              /**< without a common frame */
  int32_t lost_events;           /**< times the state fell to LOST */
  int32_t map_revision;          /**< see unisim_report */
  int32_t reserved;              /**< 0 */
  size_t arena_bytes;            /**< handed over */
  size_t arena_peak_bytes;       /**< most ever in use */
  int32_t first_keyframe;        /**< oldest keyframe that can still be read */
  int32_t retired_keyframes;     /**< that have left the sliding window */
  int32_t retired_unread;        /**< gone before unisim_next_retired() was asked for them */
  int32_t stretches;             /**< of keyframes closed by their pairs because no window came */
  int32_t suspended_loops;       /**< now */
  int32_t loop_suspensions;      /**< so far */
  int32_t loop_returns;          /**< suspended ones that agreed again */
  int32_t loops_removed;         /**< by unisim_remove_loop() */
  int32_t loops_dropped;         /**< to stay within memory: others say much the same */
  int32_t reserved_2;            /**< 0 */
  unisim_refusal refused_pair;   /**< the newest */
  unisim_refusal refused_window; /**< the newest, updates included */
  unisim_refusal refused_loop;   /**< the newest, updates included */
} unisim_session_info;

/** Read the counters.
 *  @param session live session
 *  @param[out] info filled on success
 *  @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT, UNISIM_ERR_ABI_MISMATCH */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_get_info(const unisim_session* session,
                                                          unisim_session_info* info);

#ifdef __cplusplus
}
#endif

#endif
