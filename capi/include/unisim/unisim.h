/* SPDX-License-Identifier: MIT */
/** @file unisim.h
 *  Visual SLAM back end on Sim(3) in memory stated at creation.
 *
 *  A session takes keyframes and the predictions made on them (two-view, multi-view), joins them in
 *  one factor graph on Sim(3) and gives back poses. It never calls a network, a camera, a clock,
 *  the heap or a thread: unisim_next_request() says which prediction it wants next, the host makes
 *  it when and where it likes and hands it in.
 *
 *  Conventions, the same everywhere:
 *  - A similarity acts as  p' = s R p + t.  T_a_b takes points of frame b to frame a.
 *  - Camera frames have OpenCV axes (x right, y down, z forward). Poses are camera-to-world.
 *  - Tangent order is translation 3, rotation 3, log-scale 1; updates act on the right.
 *  - Quaternions are x y z w. Lengths have no unit: one camera alone does not see scale (metric.h).
 *  Time is in nanoseconds of the host's choice of clock. Indices start at 0.
 *  - Every struct with `struct_size` is filled by its caller with sizeof the struct. A size below
 *    that of the first release is UNISIM_ERR_ABI_MISMATCH; a smaller one than today's takes
 *    defaults for the missing tail; a larger one (up to 65536 bytes) is accepted when the unknown
 *    tail is all zero, and results are written with zeros there.
 *  - Ids of keyframes and of submaps are given once, from 0 up to 2147418111. When either are used
 *    up, UNISIM_ERR_CAPACITY is the answer to more of both and everything else goes on;
 *    unisim_session_reset() starts over.
 *  - Pointers handed in are read during the call and not kept, the arena excepted.
 *  - One session, one thread at a time; different sessions are independent; there is no global
 *    state.
 *  - On any error the session is as it was before the call.
 *
 *  Include this file only: it brings types.h (statuses, plain values), config.h (configuration,
 *  life cycle), results.h (what comes out), metric.h (metres) and snapshot.h (maps that outlive the
 *  run); data in, requests and unisim_optimize() are below. */
#ifndef UNISIM_UNISIM_H
#define UNISIM_UNISIM_H

#include "unisim/config.h"
#include "unisim/metric.h"
#include "unisim/results.h"
#include "unisim/snapshot.h"
#include "unisim/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ------------------------------------------------------------------ data in */

/** A keyframe: its time only, images stay with the host. */
typedef struct unisim_keyframe {
  uint32_t struct_size; /**< sizeof this struct, set by the caller */
  int32_t reserved;     /**< 0 */
  int64_t timestamp_ns; /**< time of the image */
} unisim_keyframe;

/** Append a keyframe.
 *  @param session live session
 *  @param[in]  keyframe timestamps must grow; the first one after unisim_load_map() may be anything
 *  @param[out] id       0, 1, 2 ... in order of arrival
 *  @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT (NULL, time not after the last),
 *          UNISIM_ERR_CAPACITY (full batch: max_keyframes; sliding window: ids used up) */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_add_keyframe(unisim_session* session,
                                                              const unisim_keyframe* keyframe,
                                                              int32_t* id);

/** Two-view prediction of consecutive keyframes i and j, in a unit of its own. j is i + 1, or,
 *  where the track was lost and found again, the next keyframe of the segment. */
typedef struct unisim_two_view {
  uint32_t struct_size;     /**< sizeof this struct, set by the caller */
  int32_t i;                /**< earlier keyframe */
  int32_t j;                /**< i + 1, or further on over keyframes of no or other segments */
  int32_t reserved;         /**< 0 */
  unisim_sim3 T_i_j;        /**< camera j to camera i, scale 1 */
  unisim_depth_map depth_i; /**< same unit as T_i_j */
  unisim_depth_map depth_j; /**< same unit as T_i_j */
  double center_sigma;    /**< predicted standard deviation of the camera centres over median depth;
                               0: not known, the scatter of the depth ratios stands in */
  double log_scale_sigma; /**< standard deviation of the logarithm of the scale that is carried over
                             from i, where depth_i does not show it: a camera that turned on the
                             spot sees nothing it has measured. 0: as good as the depth ratios */
} unisim_two_view;

/** Add the two-view prediction of keyframes i and j: sets the live pose of j, and answers the
 *  UNISIM_REQUEST_PAIR of j - 1 and j. Over a gap, where the pairs of all keyframes between were
 *  refused, the state becomes UNISIM_STATE_RELOCALISED and no new segment begins.
 *
 *  depth_i is compared with the depth keyframe i had in the pair before: that ratio carries scale
 *  along the chain. With fewer than 16 grid cells in common it is taken as 1 and the edge counts a
 *  hundredth.
 *
 *  With log_scale_sigma over 0.1 the pose of j is taken and the state is DEGRADED; the pair, and
 *  windows over it, weigh accordingly little until a loop or an update of the window settles it.
 *  @param session live session
 *  @param[in] two_view see unisim_two_view
 *  @return UNISIM_OK (refused for its quality too: then unisim_get_info() counts it and says why,
 *          the pose is held and the state is DEGRADED or LOST); UNISIM_ERR_INVALID_ARGUMENT on
 *  NULL, non-finite numbers, scale other than 1, ids not consecutive (one between is of
 *  i's segment, i has no pose) or already given; UNISIM_ERR_RETIRED when i, before a gap, has left
 *  the sliding window; UNISIM_ERR_NOT_READY when keyframe j or the pair before is not there yet */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_add_two_view(unisim_session* session,
                                                              const unisim_two_view* two_view);

/** Multi-view prediction: local poses and depth of a window of keyframes, in a unit of its own. */
typedef struct unisim_submap {
  uint32_t struct_size;        /**< sizeof this struct, set by the caller */
  int32_t count;               /**< views, 2..window_size */
  const int32_t* keyframe_ids; /**< count ids, ascending; views the predictor lost are left out */
  const unisim_sim3* T_submap_kf; /**< count poses, scale 1, any gauge */
  const unisim_depth_map* depth;  /**< count maps, same unit as the poses */
  double center_sigma;            /**< as in unisim_two_view */
} unisim_submap;

/** Add the submap of a window; answers the UNISIM_REQUEST_WINDOW with its keyframes, or the oldest
 *  that holds them all.
 *
 *  A view without 16 grid cells of depth in common with its keyframe's two-view depth takes no
 *  part; a keyframe whose pair was refused gets its pose from the submap. A submap over two
 *  segments joins them: the younger one moves as a whole.
 *  @param session live session
 *  @param[in] submap see unisim_submap
 *  @param[out] submap_id id for unisim_update_submap(); -1 when refused for its quality, or when
 *                        fewer than two views are left: unisim_get_info() counts it and says why,
 *                        the request is answered
 *  @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT (also: no open request holds the keyframes),
 *          UNISIM_ERR_CAPACITY, UNISIM_ERR_NOT_READY (a keyframe whose two-view prediction is
 *          open) */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_add_submap(unisim_session* session,
                                                            const unisim_submap* submap,
                                                            int32_t* submap_id);

/** Add a loop submap: views around two distant places. Its edges are robust (Geman-McClure). A loop
 *  between two segments joins them and the state becomes UNISIM_STATE_RELOCALISED.
 *  @param session live session
 *  @param[in] submap see unisim_submap
 *  @param[out] submap_id as for unisim_add_submap()
 *  @return as unisim_add_submap(); UNISIM_ERR_RETIRED when a keyframe is no longer kept */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_add_loop(unisim_session* session,
                                                          const unisim_submap* submap,
                                                          int32_t* submap_id);

/** Better measurements of a submap that is in the graph (the predictor has re-adjusted the
 *  window). */
typedef struct unisim_submap_update {
  uint32_t struct_size;           /**< sizeof this struct, set by the caller */
  int32_t submap_id;              /**< as unisim_add_submap() gave it */
  int32_t count;                  /**< the count it was added with */
  int32_t scale_settled;          /**< 1: what unisim_two_view.log_scale_sigma called a guess within
                                     this window is measured now, and counts fully again */
  const unisim_sim3* T_submap_kf; /**< count poses, scale 1, any gauge */
  const double* log_depth_ratio;  /**< count values: log median(new / old depth) of each view; old:
                                     of the last measurement handed in */
  double center_sigma;            /**< as in unisim_two_view */
} unisim_submap_update;

/** Replace the measurement of a submap: poses, depth ratios, quality. Beyond the gate the old one
 *  stays; unisim_get_info() counts that among the refused. A submap that has left the window of
 *  unisim_config.window_submaps keeps its measurement, whatever comes.
 *  @param session live session
 *  @param[in] update see unisim_submap_update
 *  @return UNISIM_OK (refused for its quality too), UNISIM_ERR_INVALID_ARGUMENT (also: unknown
 *          submap, other count, ratios that lead out of the range of numbers), UNISIM_ERR_RETIRED
 *  when the submap is no longer kept */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_update_submap(unisim_session* session,
                                                               const unisim_submap_update* update);

/* ------------------------------------------------------------------ what the session wants next */

#define UNISIM_REQUEST_PAIR 1u   /**< two consecutive keyframes: unisim_add_two_view() */
#define UNISIM_REQUEST_WINDOW 2u /**< a window: unisim_add_submap() */
#define UNISIM_REQUEST_LOOP 4u   /**< two places that look alike; not offered yet */

/** A prediction the session wants. */
typedef struct unisim_request {
  uint32_t struct_size;                   /**< sizeof this struct, set by the caller */
  uint32_t kind;                          /**< one of UNISIM_REQUEST_* */
  int32_t count;                          /**< keyframes: 2 for a pair */
  int32_t keyframe_ids[UNISIM_MAX_VIEWS]; /**< ascending */
} unisim_request;

/** The oldest open request of the given kinds. Pairs (0,1), (1,2) ... in order; a window once all
 *  its pairs are settled, with UNISIM_PRESET_PAPER the pair after it too. UNISIM_REQUEST_LOOP is
 *  kept for later: loops are the host's to find. Asking does not change it: it stays open until the
 *  prediction is added or unisim_reject_request() is called.
 *  @param session live session
 *  @param      kinds   bits of UNISIM_REQUEST_*
 *  @param[out] request filled on success
 *  @return UNISIM_OK, UNISIM_ERR_NOT_READY when there is none, UNISIM_ERR_INVALID_ARGUMENT */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_next_request(unisim_session* session,
                                                              uint32_t kinds,
                                                              unisim_request* request);

/** Say that the prediction cannot be made (lost track, rejected by the predictor). A pair: the pose
 *  of j is held and the state falls to DEGRADED, after lost_after in a row to LOST; a later pair
 *  that succeeds starts a new segment. A window: it is left out of the map.
 *  @param session live session
 *  @param[in] request as unisim_next_request() gave it
 *  @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT when it is not an open request */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_reject_request(unisim_session* session,
                                                                const unisim_request* request);

/** Ask for the last, shorter window too: call at the end of a recording. The next
 *  UNISIM_REQUEST_WINDOW covers the keyframes no full window has covered, and the overlap.
 *  @param session live session
 *  @return UNISIM_OK, UNISIM_ERR_NOT_READY when fewer than two keyframes are left over */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_close_window(unisim_session* session);

/* ------------------------------------------------------------------ optimise */

/** Work allowed to one unisim_optimize(): iterations, never time. */
typedef struct unisim_budget {
  uint32_t struct_size;   /**< sizeof this struct, set by the caller */
  int32_t max_iterations; /**< 0: unisim_config.max_iterations */
} unisim_budget;

#define UNISIM_STOP_CONVERGED 0    /**< relative cost change or step below 1e-7 */
#define UNISIM_STOP_BUDGET 1       /**< iterations used up */
#define UNISIM_STOP_NO_DESCENT 2   /**< damping at its limit; the last accepted poses stay */
#define UNISIM_STOP_NOT_POSITIVE 3 /**< the system stayed singular; see bad_node */

/** What an optimisation did. */
typedef struct unisim_report {
  uint32_t struct_size;     /**< sizeof this struct, set by the caller */
  int32_t stop;             /**< UNISIM_STOP_* */
  int32_t iterations;       /**< accepted and rejected steps */
  int32_t keyframes;        /**< keyframe poses in the graph */
  int32_t submaps;          /**< submap poses in the graph */
  int32_t edges;            /**< factors */
  int32_t factor_blocks;    /**< 7x7 blocks of the Cholesky factor */
  int32_t bad_node;         /**< keyframe id of a singular pivot, -1 if none; submap m is -2 - m */
  double initial_cost;      /**< before the first step */
  double final_cost;        /**< at the poses that stay */
  int32_t map_revision;     /**< grows with every optimisation that moved the past */
  int32_t first_changed;    /**< keyframes that moved by more than 1e-4, -1 if none */
  int32_t last_changed;     /**< -1 if none */
  int32_t reserved;         /**< 0 */
  double jump_translation;  /**< how the newest pose moved: length in the world's unit */
  double jump_rotation_rad; /**< angle */
  double jump_log_scale;    /**< log of the factor */
} unisim_report;

/** Optimise the graph from the present poses (Levenberg-Marquardt). Never aborts: poses stay at the
 *  last accepted step. Each segment keeps its first keyframe where it is. In a sliding window the
 *  past, which only loops tie together, stays when nothing but windows have come since the last
 *  call.
 *  @param session live session
 *  @param[in]  budget NULL: the configured cap
 *  @param[out] report may be NULL
 *  @return UNISIM_OK, UNISIM_ERR_NOT_READY with nothing to optimise, UNISIM_ERR_NUMERICAL
 *          (report says where), UNISIM_ERR_CAPACITY when loops tangle the graph beyond the
 *          solver's memory, UNISIM_ERR_INVALID_ARGUMENT */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_optimize(unisim_session* session,
                                                          const unisim_budget* budget,
                                                          unisim_report* report);

#ifdef __cplusplus
}
#endif

#endif
