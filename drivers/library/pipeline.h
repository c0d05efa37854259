/* SPDX-License-Identifier: MIT */
/** @file pipeline.h
 *  From frames to poses in C: a source of frames, a predictor and a session, run on a thread of
 *  their own.
 *
 *      unisim_pipeline_config config;
 *      unisim_pipeline_config_init(&config, sizeof config);
 *      config.source = unisim_v4l2_open(NULL, NULL, message, sizeof message);
 *      config.live = 1;
 *      config.on_pose = print_pose;
 *      unisim_pipeline* pipeline = unisim_pipeline_start(&config, message, sizeof message);
 *      while (unisim_pipeline_poll(pipeline, 1000) == UNISIM_PIPELINE_RUNS) continue;
 *      unisim_pipeline_stop(pipeline);
 *
 *  The source is one of the library (v4l2.h, sequence.h) or the host's own unisim_source; the
 *  predictor likewise (geometric.h, onnx.h, recorded.h). Both belong to the pipeline from
 *  unisim_pipeline_start() on, also when it fails.
 *
 *  Callbacks are called on the pipeline's thread, one at a time, in the order of what they tell.
 *  Tracking waits for them: they should hand on and return. Pointers are valid during the call.
 *  They may call unisim_pipeline_ask_stop(), _add_odometry() and _add_distance() and nothing else
 *  of this header.
 *
 *  Lengths are in the map's own unit: one camera does not see metres. Odometry, known distances,
 *  the camera's height over the ground or a predictor that knows metres say how long that is:
 *  metres_per_unit beside the poses, from then on. */
#ifndef UNISIM_DRIVERS_LIBRARY_PIPELINE_H
#define UNISIM_DRIVERS_LIBRARY_PIPELINE_H

#include <stddef.h>
#include <stdint.h>

#include "drivers/predictor.h"
#include "drivers/source.h"
#include "unisim/unisim.h"

#ifdef __cplusplus
extern "C" {
#endif

/** What a run is doing. */
#define UNISIM_PIPELINE_RUNS 0
#define UNISIM_PIPELINE_FINISHED 1 /**< the source has ended; the map is complete */
#define UNISIM_PIPELINE_STOPPED 2  /**< it was asked to; the map is complete up to there */
#define UNISIM_PIPELINE_FAILED 3   /**< unisim_pipeline_message() says what, where, what to do */

/** A pose as it is known first, before any correction. With every_frame that of a keyframe's frame
 *  comes before the map has taken the keyframe. What is known only after newer frames had come, as
 *  of those before the start, is told too: see timestamp_ns. */
typedef struct unisim_live_pose {
  uint32_t struct_size;    /**< sizeof this struct in the library */
  int32_t keyframe_id;     /**< -1: a frame between keyframes */
  int64_t timestamp_ns;    /**< of the frame */
  unisim_sim3 T_world_cam; /**< camera to world; lengths in the map's unit */
  int32_t state;           /**< UNISIM_STATE_* */
  int32_t segment;         /**< poses of different segments have no common frame or scale; -1: none
                                known */
  int32_t reason;          /**< UNISIM_REASON_* of predictor.h, with the frame before this one;
                                0: all was well */
  int32_t reserved;        /**< 0 */
  double metres_per_unit;  /**< of lengths in T_world_cam, as known by now; 0: not known, they are
                                relative */
  double scale_sigma;      /**< its relative standard deviation */
} unisim_live_pose;

/** What an optimisation did to the poses given out before it. */
typedef struct unisim_correction {
  uint32_t struct_size;  /**< sizeof this struct in the library */
  int32_t map_revision;  /**< after it */
  int32_t first_changed; /**< keyframes that moved, see unisim_report */
  int32_t last_changed;
  int32_t keyframe_id;    /**< the newest one with a pose */
  int32_t segment;        /**< of it */
  int64_t timestamp_ns;   /**< of it */
  unisim_sim3 T_new_old;  /**< world before to world after: T_new_old * pose before = pose now */
  double metres_per_unit; /**< after it, of lengths in the segment; 0: not known */
  double scale_sigma;     /**< its relative standard deviation */
} unisim_correction;

/** Where a run stands. */
typedef struct unisim_pipeline_status {
  uint32_t struct_size;   /**< sizeof this struct, set by the caller */
  int32_t state;          /**< UNISIM_STATE_* */
  int64_t frames;         /**< tracked */
  int64_t frames_bad;     /**< unreadable */
  int64_t frames_dropped; /**< late, or given up for newer ones */
  int32_t keyframes;
  int32_t submaps;
  int32_t reason;   /**< UNISIM_REASON_* of predictor.h: why the state is what it is, or what is
                         wrong with the newest frame; 0: all is well */
  int32_t reserved; /**< 0 */
  double metres_per_unit; /**< of lengths in the newest pose's segment; 0: not known, they are
                               relative */
  double scale_sigma;     /**< its relative standard deviation */
} unisim_pipeline_status;

/** Everything a run is started with. Fill with unisim_pipeline_config_init(), then edit. */
typedef struct unisim_pipeline_config {
  uint32_t struct_size;  /**< sizeof this struct, set by the caller */
  int32_t live;          /**< 1: the source is a camera: of frames that wait the newest is taken
                              (0) */
  int32_t realtime;      /**< 1: a recording is played at its own pace, late frames are dropped
                              (0) */
  int32_t every_frame;   /**< 1: frames between keyframes get a pose too (1) */
  int32_t stride;        /**< every N-th frame is a keyframe; 0: by motion (0) */
  int32_t patience_ms;   /**< a source that gives nothing for so long has failed; 0: never
                              (60000) */
  unisim_source* source; /**< taken over (NULL: an error) */
  unisim_predictor* predictor;  /**< taken over; NULL: the geometric one with its defaults (NULL) */
  const unisim_config* session; /**< copied; NULL: a sliding window of 24 submaps (NULL) */

  void (*on_pose)(const unisim_live_pose* pose, void* user);              /**< (NULL) */
  void (*on_correction)(const unisim_correction* correction, void* user); /**< (NULL) */
  void (*on_keyframe)(const unisim_pose* keyframe, void* user); /**< with its first pose (NULL) */
  void (*on_state)(int32_t state, void* user);                  /**< it has changed (NULL) */
  void (*on_message)(const char* line, void* user);             /**< worth telling (NULL) */
  void* user;                                                   /**< of the callbacks (NULL) */

  struct unisim_lcm_publisher*
      lcm;                /**< the run is told over it (lcm_publisher.h), all channels but
                               images and points; borrowed, used on the pipeline's thread:
                               destroy it after unisim_pipeline_stop(); NULL: not (NULL) */
  const char* lcm_folder; /**< copied; on its disk lie the poses of keyframes that have left the
                               window, to be sent again after loops, some 200 bytes each; NULL: in
                               memory (NULL) */
  int32_t lcm_images;     /**< 1: each frame is sent too (0) */
  int32_t lcm_points;     /**< points sent of each submap; 0: none (0) */

  const char* load_map; /**< copied; file of an earlier run to go on in: the session needs the shape
                             it had then; NULL: an empty map (NULL) */
  const char* save_map; /**< copied; file that gets the map when the run ends, in place of what it
                             was; NULL: none (NULL) */
  int32_t localise; /**< 1: frames, every stride-th, are looked for in load_map, which stays as it
                       is, and those that are found get a pose (0) */
  int32_t reserved; /**< 0 */
  double camera_height; /**< of the camera over the ground it drives on, metres: where windows see
                             the ground, lengths become metric. Give the predictor the focal
                             length too; 0: not known (0) */
} unisim_pipeline_config;

/** A run. */
typedef struct unisim_pipeline unisim_pipeline;

/** Defaults for every field.
 *  @param[out] config      struct to fill
 *  @param      struct_size sizeof(unisim_pipeline_config) of the caller */
UNISIM_API void unisim_pipeline_config_init(unisim_pipeline_config* config, size_t struct_size);

/** Make the session and start the thread.
 *  @param[in]  config   copied; its source and predictor are taken over. One of an older release,
 *                       smaller, is filled up with defaults
 *  @param[out] message  on failure one line: what, where, what to do; may be NULL
 *  @param      capacity bytes of message
 *  @return NULL on failure; else free with unisim_pipeline_stop() */
UNISIM_API unisim_pipeline* unisim_pipeline_start(const unisim_pipeline_config* config,
                                                  char* message, size_t capacity);

/** Wait for the end of the run.
 *  @param pipeline   live pipeline
 *  @param timeout_ms wait so long at most; 0: not at all
 *  @return UNISIM_PIPELINE_* */
UNISIM_API int unisim_pipeline_poll(unisim_pipeline* pipeline, int32_t timeout_ms);

/** Why the run failed.
 *  @param pipeline that unisim_pipeline_poll() says FAILED of
 *  @return one line owned by the pipeline; "" where it did not */
UNISIM_API const char* unisim_pipeline_message(const unisim_pipeline* pipeline);

/** Where the run stands. From any thread but those of callbacks.
 *  @param      pipeline live pipeline
 *  @param[out] status   filled as far as its struct_size reaches */
UNISIM_API void unisim_pipeline_get_status(const unisim_pipeline* pipeline,
                                           unisim_pipeline_status* status);

/** How far the camera has gone, as wheels, legs or inertial navigation say. */
typedef struct unisim_odometry_step {
  uint32_t struct_size; /**< sizeof this struct, set by the caller */
  int32_t reserved;     /**< 0 */
  int64_t from_ns;      /**< on the clock of the frames */
  int64_t to_ns;        /**< later; between steps of more than a second nothing is interpolated */
  double metres;        /**< path of the camera between the two, >= 0 */
  double sigma;         /**< its standard deviation over metres, apart from common_sigma; 0: 0.02 */
  double common_sigma;  /**< relative error that all steps share, 0..1: no number of them makes the
                             scale surer; 0: 0.05 */
} unisim_odometry_step;

/** Say how far the camera went between two times: lengths become metric. Best 10 times a second or
 *  more often, as it comes; frames that it has not reached yet wait for it. The newest 8192 steps
 *  are kept. From any thread, callbacks too; steps in the order of their times.
 *  @param pipeline live pipeline
 *  @param[in] step see unisim_odometry_step; a step that begins later than the one before ended
 *                  leaves a gap
 *  @return 1; 0: NULL, an unknown struct_size, numbers out of range, a step that begins before the
 *          one before ended, or no room: the run does not take them */
UNISIM_API int unisim_pipeline_add_odometry(unisim_pipeline* pipeline,
                                            const unisim_odometry_step* step);

/** Say how far two keyframes are apart: unisim_add_distance() for the session of the run, which
 *  takes it with its next keyframe; what it refuses (keyframes unknown or gone, numbers out of
 *  range) comes as a message. From any thread, callbacks too.
 *  @param pipeline live pipeline
 *  @param[in] distance see metric.h
 *  @return 1; 0: NULL, an unknown struct_size, or no room */
UNISIM_API int unisim_pipeline_add_distance(unisim_pipeline* pipeline,
                                            const unisim_distance* distance);

/** A reason in one or a few words.
 *  @param reason UNISIM_REASON_* of predictor.h
 *  @return static text, "" for none and for numbers that are none */
UNISIM_API const char* unisim_reason_name(int32_t reason);

/** The newest pose, as on_pose() told it: for hosts that would rather ask. From any thread but
 *  those of callbacks.
 *  @param      pipeline live pipeline
 *  @param[out] pose     struct_size set by the caller, filled as far as it reaches
 *  @return 1; 0 while there is none */
UNISIM_API int unisim_pipeline_get_pose(const unisim_pipeline* pipeline, unisim_live_pose* pose);

/** Ask the run to end; it does within a second. From any thread, callbacks and signal handlers too.
 *  @param pipeline live pipeline */
UNISIM_API void unisim_pipeline_ask_stop(unisim_pipeline* pipeline);

/** End the run if it goes on, wait for it, free everything. NULL is fine.
 *  @return how the run ended, UNISIM_PIPELINE_* */
UNISIM_API int unisim_pipeline_stop(unisim_pipeline* pipeline);

#ifdef __cplusplus
}
#endif

#endif
