/* SPDX-License-Identifier: MIT */
/** @file config.h
 *  What a session is made with, its memory and its life; included by unisim.h. */
#ifndef UNISIM_CONFIG_H
#define UNISIM_CONFIG_H

#include "unisim/types.h"

#ifdef __cplusplus
extern "C" {
#endif

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
  double sigma_factor;       /**< true errors over center_sigma: covariances are at least what the
                                  predictor's center_sigma times this leads to, however well its
                                  answers agree among each other; that windows overlap is allowed
                                  for. 4 for sigmas of a bundle adjustment that takes residuals for
                                  independent, 1 for honest ones; 0: residuals alone say it (4) */
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
 *  @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT, UNISIM_ERR_OUT_OF_MEMORY (more than this machine
 *          can address), UNISIM_ERR_ABI_MISMATCH */
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
 *  @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT, UNISIM_ERR_CAPACITY, UNISIM_ERR_OUT_OF_MEMORY,
 *          UNISIM_ERR_ABI_MISMATCH */
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

/** End a session; the arena is the caller's again. NULL is fine. As long as the arena is not used
 *  for anything else, later calls with this session are UNISIM_ERR_INVALID_ARGUMENT. */
UNISIM_API void unisim_session_destroy(unisim_session* session);

#ifdef __cplusplus
}
#endif

#endif
