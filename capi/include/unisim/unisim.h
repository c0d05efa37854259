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
 *  - Quaternions are x y z w. Lengths have no unit: one camera alone does not see scale. Time is in
 *    nanoseconds of the host's choice of clock. Indices start at 0.
 *  - Every struct with `struct_size` is filled by its caller with sizeof the struct. A size below
 *    that of the first release is UNISIM_ERR_ABI_MISMATCH; a smaller one than today's takes
 *    defaults for the missing tail; a larger one is accepted when the unknown tail is all zero.
 *  - Pointers handed in are read during the call and not kept, the arena excepted.
 *  - One session, one thread at a time; different sessions are independent; there is no global
 *    state.
 *  - On any error the session is as it was before the call. */
#ifndef UNISIM_UNISIM_H
#define UNISIM_UNISIM_H

#include <stddef.h>
#include <stdint.h>

#include "unisim/version.h"

#if defined(__GNUC__)
/** Marks what the library exports. */
#define UNISIM_API __attribute__((visibility("default")))
/** Marks calls whose status must be looked at. */
#define UNISIM_NODISCARD __attribute__((warn_unused_result))
#else
#define UNISIM_API
#define UNISIM_NODISCARD
#endif

#ifdef __cplusplus
extern "C" {
#endif

/** Result of a call. The numbers never move; 0 is success. */
typedef int32_t unisim_status;
#define UNISIM_OK 0                   /**< done */
#define UNISIM_ERR_INVALID_ARGUMENT 1 /**< NULL, non-finite, unknown id: caller's mistake */
#define UNISIM_ERR_CAPACITY 2      /**< a declared capacity or the caller's buffer is too small */
#define UNISIM_ERR_OUT_OF_MEMORY 3 /**< the arena is smaller than unisim_arena_size() says */
#define UNISIM_ERR_NOT_READY 4     /**< nothing to do or to give yet */
#define UNISIM_ERR_NUMERICAL 5     /**< no descent or not positive definite; poses stay */
#define UNISIM_ERR_INTERNAL 6      /**< broken invariant; all later calls until reset say so */
#define UNISIM_ERR_ABI_MISMATCH 7  /**< struct_size is not one this library knows */
#define UNISIM_ERR_RETIRED 8       /**< was there, and has made room for newer ones */

/** Fixed text for a status code; never NULL. */
UNISIM_API const char* unisim_status_string(unisim_status status);

/** UNISIM_VERSION_NUMBER of the library that is linked. */
UNISIM_API int32_t unisim_version(void);

/* ------------------------------------------------------------------ plain values */

/** Similarity p' = s R p + t. */
typedef struct unisim_sim3 {
  double q[4]; /**< rotation, unit quaternion x y z w */
  double t[3]; /**< translation */
  double s;    /**< scale, > 0 */
} unisim_sim3;

/** Depth map of one keyframe in one prediction; any size, the pixel grid of its own prediction.
 *  A pixel whose depth is not finite or <= 0, or whose confidence is not finite, has no depth. */
typedef struct unisim_depth_map {
  const float* depth; /**< height*width z-depths, row-major, unit of the prediction */
  const float*
      confidence; /**< same shape, larger is better, only its order counts; NULL: all equal */
  int32_t width;  /**< pixels */
  int32_t height; /**< pixels */
} unisim_depth_map;

/** Largest number of keyframes one prediction may hold. */
#define UNISIM_MAX_VIEWS 64

/* ------------------------------------------------------------------ configuration, life cycle */

/** How measurements enter the graph. */
#define UNISIM_PRESET_CONSISTENT 0 /**< scale ratios inside the pose edges (default) */
#define UNISIM_PRESET_PAPER 1 /**< scale 1 in pose edges and weights 1 1 50 50 0.2, as printed */

/** Factors that unisim_config.disabled_factors may switch off (for ablations). */
#define UNISIM_FACTOR_TWO_VIEW 1u     /**< neighbouring keyframes */
#define UNISIM_FACTOR_BRIDGE 2u       /**< submap to each of its keyframes */
#define UNISIM_FACTOR_SCALE_ANCHOR 4u /**< scale of a submap against each of its keyframes */
#define UNISIM_FACTOR_TIE 8u          /**< two submaps over a shared keyframe */
#define UNISIM_FACTOR_SCALE 16u       /**< scale of two submaps that share keyframes */

/** Levels of the log callback. */
#define UNISIM_LOG_INFO 1    /**< worth knowing */
#define UNISIM_LOG_WARNING 2 /**< something was refused */

/** Optional log callback, called on the caller's thread; may not call the session.
 *  @param level UNISIM_LOG_*
 *  @param text  zero-ended, valid during the call
 *  @param user  unisim_config.log_user */
typedef void (*unisim_log_fn)(int32_t level, const char* text, void* user);

/** Everything a session is made with. Fill with unisim_config_init(), then edit. */
typedef struct unisim_config {
  uint32_t struct_size;   /**< sizeof this struct, set by the caller */
  int32_t preset;         /**< UNISIM_PRESET_* */
  int32_t window_size;    /**< keyframes per submap w, 2..UNISIM_MAX_VIEWS (16) */
  int32_t window_overlap; /**< keyframes shared by neighbouring submaps, 0..window_size-1 (2) */
  int32_t max_keyframes;  /**< capacity, 2..65536; with window_submaps the newest keyframes that
                               stay readable, at least (window_submaps + 9) window_size (1024) */
  int32_t max_submaps; /**< capacity, 0: enough for max_keyframes; later windows are skipped. With
                            window_submaps the newest windows that stay readable (0) */
  int32_t max_loops;   /**< capacity of loop submaps, 0..4096; with window_submaps the newest ones
                            that stay readable, 0: no loops (64) */
  int32_t depth_grid_width;   /**< depth maps are sampled on this grid for ratios, 4..512 (80) */
  int32_t depth_grid_height;  /**< 4..512 (60) */
  uint32_t disabled_factors;  /**< bits UNISIM_FACTOR_* (0) */
  double weight_two_view;     /**< information of a two-view edge; 0: the preset's, 1 (0) */
  double weight_bridge;       /**< 0: the preset's, 1 (0) */
  double weight_scale_anchor; /**< 0: the preset's, 1 or 50 (0) */
  double weight_tie;          /**< 0: the preset's, 0.2 (0) */
  double weight_scale;        /**< 0: the preset's, 1 or 50 (0) */
  double huber_delta;         /**< Huber width of ordinary edges, whitened (1) */
  double loop_delta;          /**< Geman-McClure width of loop edges, whitened (0.1) */
  double live_scale_exponent; /**< g of the live chain: scale step r^g, 0..1 (0.5) */
  double confidence_drop; /**< share of least confident pixels left out of ratios, 0..0.9 (0.25) */
  double sigma_reference; /**< center_sigma up to which an edge has its full weight (0.001) */
  double sigma_gate;      /**< submaps with a larger center_sigma are refused (0.005) */
  double sigma_gate_loop; /**< the same for loops (0.002) */
  double scatter_gate;    /**< without center_sigma: submaps and pairs whose depth ratios scatter
                               more (median absolute deviation of the log) are refused (0.13) */
  int32_t lost_after;     /**< rejected pairs in a row until the state is LOST (3) */
  int32_t max_iterations; /**< cap of one unisim_optimize() whose budget says 0 (10) */
  unisim_log_fn log;      /**< NULL: silent */
  void* log_user;         /**< handed to log */
  int32_t window_submaps; /**< newest windows whose keyframes are optimised, 2..64. Older keyframes
                               keep the place in their submap that unisim_optimize() last gave them
                               (call it after each window) and move with it; what joined two
                               submaps becomes one edge. The session then runs for ever in its
                               arena and refuses nothing for want of room: keyframes that no
                               window comes for are closed into the skeleton by their pairs.
                               0: all of them, the full batch (0) */
  int32_t skeleton_capacity; /**< with window_submaps: submaps older than that are optimised one by
                                  one up to this many, 8..65536; beyond, neighbours in time become
                                  rigid. 0: as many as windows stay readable (128) */
  double loop_gate;          /**< whitened residual beyond which a loop is suspended after some
                                  optimisations; 0: 4 loop_delta (0) */
} unisim_config;

/** Defaults for every field.
 *  @param[out] config      struct to fill
 *  @param      struct_size sizeof(unisim_config) of the caller
 *  @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT on NULL, UNISIM_ERR_ABI_MISMATCH */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_config_init(unisim_config* config,
                                                             size_t struct_size);

/** Exact bytes a session with this configuration needs, alignment slack included.
 *  @param[in]  config ranges as stated at the fields
 *  @param[out] size   bytes
 *  @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT, UNISIM_ERR_ABI_MISMATCH */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_arena_size(const unisim_config* config,
                                                            size_t* size);

/** One part of the arena, as unisim-arena prints it. */
typedef struct unisim_arena_part {
  const char* name; /**< static text */
  size_t bytes;     /**< alignment included */
} unisim_arena_part;

/** The bytes of unisim_arena_size() by part.
 *  @param[in]  config   as for unisim_arena_size()
 *  @param[out] parts    caller's array
 *  @param      capacity its length
 *  @param[out] count    parts written; the needed number on UNISIM_ERR_CAPACITY
 *  @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT, UNISIM_ERR_CAPACITY, UNISIM_ERR_ABI_MISMATCH */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_arena_parts(const unisim_config* config,
                                                             unisim_arena_part* parts,
                                                             size_t capacity, size_t* count);

/** A session. All its bytes lie in the arena. */
typedef struct unisim_session unisim_session;

/** Make a session in the caller's memory. The last thing that could need memory: nothing is asked
 *  of the system here or later.
 *  @param[out] session set on success
 *  @param[in]  config  copied
 *  @param[in]  arena   caller's, any alignment, kept until unisim_session_destroy()
 *  @param      size    bytes of arena, at least unisim_arena_size()
 *  @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT, UNISIM_ERR_OUT_OF_MEMORY,
 *          UNISIM_ERR_ABI_MISMATCH */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_session_create(unisim_session** session,
                                                                const unisim_config* config,
                                                                void* arena, size_t size);

/** Back to the state after create; also the way out of UNISIM_ERR_INTERNAL.
 *  @param session live session
 *  @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_session_reset(unisim_session* session);

/** End a session; the arena is the caller's again. NULL is fine. As long as the arena is not used for
 *  anything else, later calls with this session are UNISIM_ERR_INVALID_ARGUMENT. */
UNISIM_API void unisim_session_destroy(unisim_session* session);

/* ------------------------------------------------------------------ data in */

/** A keyframe: its time only, images stay with the host. */
typedef struct unisim_keyframe {
  uint32_t struct_size; /**< sizeof this struct, set by the caller */
  int32_t reserved;     /**< 0 */
  int64_t timestamp_ns; /**< time of the image */
} unisim_keyframe;

/** Append a keyframe.
 *  @param session live session
 *  @param[in]  keyframe timestamps must grow
 *  @param[out] id       0, 1, 2 ... in order of arrival
 *  @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT (NULL, time not after the last),
 *          UNISIM_ERR_CAPACITY (full batch only) */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_add_keyframe(unisim_session* session,
                                                              const unisim_keyframe* keyframe,
                                                              int32_t* id);

/** Two-view prediction of consecutive keyframes i and j = i + 1, in a unit of its own. */
typedef struct unisim_two_view {
  uint32_t struct_size;     /**< sizeof this struct, set by the caller */
  int32_t i;                /**< earlier keyframe */
  int32_t j;                /**< i + 1 */
  int32_t reserved;         /**< 0 */
  unisim_sim3 T_i_j;        /**< camera j to camera i, scale 1 */
  unisim_depth_map depth_i; /**< same unit as T_i_j */
  unisim_depth_map depth_j; /**< same unit as T_i_j */
  double center_sigma; /**< predicted standard deviation of the camera centres over median depth;
                            0: not known, the scatter of the depth ratios stands in */
} unisim_two_view;

/** Add the two-view prediction of keyframes i and i + 1: sets the live pose of i + 1.
 *
 *  depth_i is compared with the depth keyframe i had in the pair before: that ratio carries scale
 *  along the chain. With fewer than 16 grid cells in common it is taken as 1 and the edge counts a
 *  hundredth.
 *  @param session live session
 *  @param[in] two_view see unisim_two_view
 *  @return UNISIM_OK (refused for its quality too: then unisim_get_info() counts it, the pose is
 *          held and the state is DEGRADED or LOST); UNISIM_ERR_INVALID_ARGUMENT on NULL,
 *          non-finite numbers, scale other than 1, ids not consecutive or already given;
 *          UNISIM_ERR_NOT_READY when keyframe j or the pair before is not there yet */
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
 *                        fewer than two views are left: unisim_get_info() counts it, the request is
 *                        answered
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
  int32_t reserved;               /**< 0 */
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
 *          submap, other count), UNISIM_ERR_RETIRED when the submap is no longer kept */
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
 *  past, which only loops tie together, stays when nothing but a window has come since the last
 * call.
 *  @param session live session
 *  @param[in]  budget NULL: the configured cap
 *  @param[out] report may be NULL
 *  @return UNISIM_OK, UNISIM_ERR_NOT_READY with nothing to optimise, UNISIM_ERR_NUMERICAL
 *          (report says where), UNISIM_ERR_CAPACITY when loops tangle the graph beyond the
 *          solver's memory, UNISIM_ERR_INVALID_ARGUMENT */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_optimize(unisim_session* session,
                                                          const unisim_budget* budget,
                                                          unisim_report* report);

/* ------------------------------------------------------------------ results out, by copy */

/** Tracking state. */
#define UNISIM_STATE_INIT 0        /**< no pose yet */
#define UNISIM_STATE_TRACKING 1    /**< the newest pair was accepted */
#define UNISIM_STATE_DEGRADED 2    /**< the newest pair was rejected, the pose is held */
#define UNISIM_STATE_LOST 3        /**< lost_after pairs in a row were rejected */
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
 *  unisim_optimize(), times its variance of unit weight (2 cost / degrees of freedom). Zero for the
 *  first keyframe of a segment, which is held. Behind a sliding window it is that of the submap
 *  that carries the keyframe, zero on the first submap. Cost: one factorisation for the first
 *  keyframe asked for, one solve with seven right-hand sides for each.
 *  @param session live session
 *  @param keyframe_id as unisim_add_keyframe() gave it
 *  @param[out] covariance 49 values, column-major
 *  @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT, UNISIM_ERR_NOT_READY when the graph has
 *          changed since or the pose is held, UNISIM_ERR_NUMERICAL, UNISIM_ERR_RETIRED */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_get_covariance(unisim_session* session,
                                                                int32_t keyframe_id,
                                                                double covariance[49]);

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

/** Take a loop back; with it those that share its edge. What it joined stays where it is, but is
 *  held together no longer.
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

/** Where the session stands. */
typedef struct unisim_session_info {
  uint32_t struct_size;      /**< sizeof this struct, set by the caller */
  int32_t state;             /**< UNISIM_STATE_* now */
  int32_t keyframes;         /**< added */
  int32_t posed_keyframes;   /**< with a pose that a prediction supports */
  int32_t last_posed;        /**< newest keyframe with a pose, -1 if none: the live pose */
  int32_t submaps;           /**< in the graph, loops not counted */
  int32_t submaps_refused;   /**< by the gates, updates included */
  int32_t loops;             /**< loop submaps in the graph */
  int32_t loops_refused;     /**< by the gates, updates included */
  int32_t pairs_refused;     /**< by the session's gates or by unisim_reject_request() */
  int32_t segments;          /**< without a common frame */
  int32_t lost_events;       /**< times the state fell to LOST */
  int32_t map_revision;      /**< see unisim_report */
  int32_t reserved;          /**< 0 */
  size_t arena_bytes;        /**< handed over */
  size_t arena_peak_bytes;   /**< most ever in use */
  int32_t first_keyframe;    /**< oldest keyframe that can still be read */
  int32_t retired_keyframes; /**< that have left the sliding window */
  int32_t retired_unread;    /**< gone before unisim_next_retired() was asked for them */
  int32_t stretches;         /**< of keyframes closed by their pairs because no window came */
  int32_t suspended_loops;   /**< now */
  int32_t loop_suspensions;  /**< so far */
  int32_t loop_returns;      /**< suspended ones that agreed again */
  int32_t loops_removed;     /**< by unisim_remove_loop() */
  int32_t loops_dropped;     /**< to stay within memory: others say much the same */
  int32_t reserved_2;        /**< 0 */
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
