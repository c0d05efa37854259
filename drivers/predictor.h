/* SPDX-License-Identifier: MIT */
/** @file predictor.h
 *  A predictor turns images into two-view and multi-view predictions. A network, a recording and
 *  our own geometry answer through the same table; nothing behind it knows of the session.
 *
 *  Order of calls: observe() for every frame in time order; keyframe() when the frame just observed
 *  is taken as a keyframe; then two_view(), multi_view(), next_revision() as the session asks.
 *  Results are borrowed: valid until the next call of the same function.
 *
 *  Threads. Two groups of functions, in each of them one call at a time:
 *  - front: observe(), keyframe(), two_view(), frame_pose(), features(), place_descriptor(),
 *    locate(), map_pose(), message();
 *  - back: multi_view(), next_revision(), next_wide_window(), release_place(), window_message().
 *  With concurrent_windows the groups run beside each other, on two threads; without it all calls
 *  come from one thread. While finish(), info(), save_map(), load_map() or destroy() runs, nothing
 *  else does. */
#ifndef UNISIM_DRIVERS_PREDICTOR_H
#define UNISIM_DRIVERS_PREDICTOR_H

#include <stddef.h>
#include <stdint.h>

#include "drivers/image.h"
#include "drivers/source.h"
#include "unisim/unisim.h"

#ifdef __cplusplus
extern "C" {
#endif

/** A replay takes the answer of multi_view() at most half as many keyframes after it has asked, and
 *  asks no later than that after the last keyframe of the window: for so long a predictor with
 *  concurrent_windows keeps what it needs of a window's keyframes. */
#define UNISIM_WINDOW_LAG 8

#define UNISIM_PREDICTION_OK 0
#define UNISIM_PREDICTION_PENDING 1  /**< not known yet: ask again after the next keyframe */
#define UNISIM_PREDICTION_REJECTED 2 /**< cannot be made; message() says why */
/** The predictor is of no more use; message() says what to do. */
#define UNISIM_PREDICTION_FAILED 3

/** Why tracking has a hard time, or the image of a frame is of little use. */
#define UNISIM_REASON_NONE 0
#define UNISIM_REASON_COVERED 1  /**< dark and nothing to be seen: the lens is covered, no light */
#define UNISIM_REASON_EXPOSURE 2 /**< most pixels as dark or as bright as can be */
#define UNISIM_REASON_BLUR 3     /**< much softer than the frames before: moved, out of focus */
/** Too little to follow: a bare wall,
 *  or what was seen is gone. */
#define UNISIM_REASON_TEXTURE 4
#define UNISIM_REASON_DUPLICATE 5 /**< the same pixels as the frame before: nothing new */
#define UNISIM_REASON_TIME_GAP 6  /**< much later after the frame before than usual */
#define UNISIM_REASON_START 7     /**< no start found yet; a predictor does not give it */
/** Images look well, but the prediction was refused:
 *  see the messages; a predictor does not give it. */
#define UNISIM_REASON_PREDICTION 8
/* While there is no map yet: what the newest keyframe lacked for a start. */
#define UNISIM_REASON_STILL 9     /**< hardly moved */
#define UNISIM_REASON_TURNED 10   /**< only turned on the spot */
#define UNISIM_REASON_PARALLAX 11 /**< moved too little for how far off all is */
/** Too few features are still seen:
 *  keyframes too far apart. */
#define UNISIM_REASON_LOST_TRACKS 12
#define UNISIM_REASON_NOT_RIGID 13 /**< does not move as a rigid scene before one camera */
/** Turned on the spot until nothing that was measured is in view: the scale is a guess. What a pair
 *  with a large log_scale_sigma comes from; a predictor does not give it. */
#define UNISIM_REASON_SPOT_TURN 14
#define UNISIM_REASON_COUNT 15 /**< one more than the last */

/** What a frame says about the camera's motion. */
typedef struct unisim_motion {
  double flow;    /**< median displacement since the last keyframe over the image diagonal; < 0: not
                     measured */
  double tracked; /**< share of the last keyframe's features still seen, 0..1; < 0: not measured */
  int32_t
      keyframe_advice; /**< 1: this frame must be a keyframe, -1: must not, 0: the caller decides */
  int32_t reason;      /**< UNISIM_REASON_* of this frame; 0 where nothing is wrong, and from
                          predictors that do not look */
} unisim_motion;

/** Two-view prediction of keyframes i, j. Unit of length: the predictor's choice for each call. */
typedef struct unisim_pair_prediction {
  unisim_sim3 T_i_j; /**< scale 1 */
  unisim_depth_map depth_i;
  unisim_depth_map depth_j;
  double focal_px;        /**< of the image, 0 if not known */
  double center_sigma;    /**< see unisim_two_view; 0 if not known */
  int32_t gap;            /**< T_i_j and depth_i are those of keyframe i - gap: the last one with a
                               pose, the track was lost and found again at j; 0: of i */
  int32_t reserved;       /**< 0 */
  double log_scale_sigma; /**< see unisim_two_view; 0: the depth maps show the scale */
} unisim_pair_prediction;

/** Multi-view prediction of a window. */
typedef struct unisim_window_prediction {
  int32_t count;                  /**< views that were solved; may be fewer than asked for */
  const int32_t* keyframe_ids;    /**< count, ascending */
  const unisim_sim3* T_window_kf; /**< count, camera to window, scale 1, any gauge */
  const unisim_depth_map* depth;  /**< count */
  double focal_px;                /**< 0 if not known */
  double center_sigma;            /**< see unisim_submap; 0 if not known */
  int64_t token;                  /**< names this window in later revisions */
  const char* remark;             /**< one line worth telling, NULL for none */
  double metres_per_unit; /**< metres in a unit of poses and depth; 0: not known, one camera does
                               not see scale. The two below go with it: see unisim_submap_unit */
  double metres_sigma;    /**< relative standard deviation of this window */
  double metres_common_sigma; /**< of all windows together */
} unisim_window_prediction;

/** A window the predictor has measured again, better. */
typedef struct unisim_window_revision {
  int64_t token;                  /**< of the unisim_window_prediction */
  int32_t count;                  /**< same views as before */
  const unisim_sim3* T_window_kf; /**< count */
  const double* log_depth_ratio;  /**< count; see unisim_submap_update */
  double center_sigma;
  int32_t scale_settled; /**< see unisim_submap_update */
  int32_t reserved;      /**< 0 */
} unisim_window_revision;

/** Pose of the frame observed last, relative to the newest keyframe. */
typedef struct unisim_frame_pose {
  unisim_sim3 T_kf_frame; /**< in the unit of depth_j of the newest pair; scale 1 */
  int32_t keyframe_id;
} unisim_frame_pose;

/** What a keyframe looks like as a whole, to find it again among thousands. */
typedef struct unisim_place_descriptor {
  const int8_t* values; /**< as unisim_places_add() takes them; the larger the dot product of two
                           vectors over their lengths, the more alike */
  int32_t dimension;    /**< numbers; the same in the whole run */
  int32_t image_width;  /**< pixels, for the unit of unisim_window_prediction.focal_px */
  int32_t image_height; /**< pixels */
  int32_t reserved;     /**< 0 */
} unisim_place_descriptor;

/** Something the predictor follows through the images. */
typedef struct unisim_feature {
  float x; /**< pixels, pixel centres at whole numbers */
  float y;
  int32_t placed; /**< 1: its place in space is known */
} unisim_feature;

/** What a keyframe was compared with an older one for. */
#define UNISIM_PLACE_LOOP 0 /**< to close a loop */
#define UNISIM_PLACE_LOST 1 /**< the track was lost: where is the camera? */
#define UNISIM_PLACE_JOIN 2 /**< to join the older one's segment to its own */

/** A keyframe compared with an older one that looks like it. With place_descriptor() depth is
 *  compared in place of features, on cells: `matches` of them, `pose_inliers` and `in_view` lie in
 *  the other view, `patch_inliers` have the depth that the other view has there. */
typedef struct unisim_place_report {
  int32_t keyframe;      /**< the newer one */
  int32_t candidate;     /**< the older one */
  int32_t asked;         /**< UNISIM_PLACE_* */
  int32_t score;         /**< of the descriptors; says in which order candidates were tried */
  int32_t matches;       /**< features that show the same landmark */
  int32_t pose_inliers;  /**< matches that agree on a pose */
  int32_t patch_inliers; /**< landmarks that look as they should from there */
  int32_t in_view;       /**< of so many */
  int32_t accepted;      /**< 1, or 0 with the reason */
  const char* reason;    /**< static text */
} unisim_place_report;

/** Takes bytes of a map that is saved. @return 1, or 0: it could not */
typedef int32_t (*unisim_map_write)(void* context, const void* bytes, size_t size);
/** Gives the next `size` bytes of a saved map. @return 1, or 0: there are not so many */
typedef int32_t (*unisim_map_read)(void* context, void* bytes, size_t size);

/** Where in the map a frame was taken. */
typedef struct unisim_location {
  unisim_sim3 T_map_frame; /**< camera to the map of `segment`, scale 1 */
  int32_t keyframe_id;     /**< keyframe of the map it was compared with */
  int32_t segment;         /**< of that keyframe: see unisim_map_pose */
  int32_t inliers;         /**< landmarks that look as they should from there */
  int32_t in_view;         /**< of so many */
  int32_t followed;        /**< 1: looked for where the frame before it was; 0: in the whole map */
  int32_t reserved;        /**< 0 */
} unisim_location;

/** A keyframe as the predictor's own map has it. */
typedef struct unisim_map_pose {
  unisim_sim3 T_map_kf; /**< camera to map, scale 1 */
  int32_t segment;      /**< poses of different segments have no common frame or unit */
  int32_t reserved;     /**< 0 */
} unisim_map_pose;

/** Things worth knowing at the end of a run. */
typedef struct unisim_predictor_info {
  double focal_px;       /**< last estimate, 0 if none */
  double focal_sigma_px; /**< its standard deviation, what the camera model leaves out included;
                            0: given, or not known */
  double radial_k1;      /**< undistorted = distorted (1 + k1 r^2), r in focal lengths; 0 if none */
  int64_t state_bytes;   /**< memory the predictor holds, 0 if not known */
  int32_t initialised;   /**< 0: never saw enough motion to start */
  int32_t restarts;      /**< times track was lost and a new segment begun */
  int32_t rotation_only; /**< keyframes recognised as turned on the spot */
  int32_t static_frames; /**< frames recognised as not moving */
  const char* no_start;  /**< while not initialised: one line of what was seen, why it gave no start
                            and what would help; NULL: nothing to tell. Borrowed until the next
                            call */
  const struct unisim_place_report* places; /**< newest looks at places, in order; borrowed until
                                                the next call. Verdicts on the newest hundreds may
                                                still change */
  int32_t place_count;                      /**< their number */
  int32_t loops_tried;    /**< old keyframes looked at for a loop, in the whole run */
  int32_t loops_accepted; /**< of these: counted loops */
  int32_t relocalised;    /**< times a lost track was found again in the map */
  int32_t joined;         /**< segments that were joined to another one */
  double center_x_px; /**< last estimate of the principal point, from the middle of the image to */
  double center_y_px; /**< the right and down; 0, 0: the middle, or not known */
  int32_t loops_undone; /**< of those accepted: hold the map no longer, since they do not agree with
                           it. Filled by the pipeline for the loops it closes itself */
  int32_t places_past;  /**< looks older than these: how many are no longer among them */
  double readout_ms;    /**< of a rolling shutter, from the first row to the last, last estimate; 0:
                             all rows at once, or not known */
} unisim_predictor_info;

/** A predictor. Free with destroy(predictor). Functions marked optional may be NULL. */
typedef struct unisim_predictor unisim_predictor;
struct unisim_predictor {
  uint32_t
      struct_size; /**< sizeof this struct, set by whoever fills it; a larger one is accepted */
  int32_t needs_images;       /**< 0: observe() and keyframe() take images with data NULL */
  const char* name;           /**< "geometric", "recorded", "onnx": static text */
  int32_t concurrent_windows; /**< 1: the groups may run beside each other. What the back group says
                                   then follows from the keyframes it is asked for and from what it
                                   was asked before, not from how far the front is: else two replays
                                   would differ */
  int32_t reserved;           /**< 0 */

  /** See one frame. @return UNISIM_PREDICTION_OK, _REJECTED (frame of no use), _FAILED */
  int (*observe)(unisim_predictor* predictor, const unisim_frame* frame, unisim_motion* motion);

  /** The frame observed last is keyframe `id` (0, 1, 2 ...). @return UNISIM_PREDICTION_OK, _FAILED
   */
  int (*keyframe)(unisim_predictor* predictor, const unisim_frame* frame, int32_t id);

  /** Pair (i, j = i + 1). @return UNISIM_PREDICTION_* */
  int (*two_view)(unisim_predictor* predictor, int32_t i, int32_t j, unisim_pair_prediction* out);

  /** Window of `count` ascending keyframe ids. @return UNISIM_PREDICTION_* */
  int (*multi_view)(unisim_predictor* predictor, const int32_t* ids, int32_t count,
                    unisim_window_prediction* out);

  /** Next window measured anew since the last call; optional. Ask until it says PENDING. Asked
   * after each keyframe, when its pose has gone out: what can wait until then may be done here. */
  int (*next_revision)(unisim_predictor* predictor, unisim_window_revision* out);

  /** Next wide window: keyframes spread over all that the predictor holds, measured together after
   *  it has adjusted them all anew. No answer to a request: it ties together what windows of
   *  neighbours cannot, and is taken as a loop is. Optional. Ask until it says PENDING.
   * @param max_views views to give at most */
  int (*next_wide_window)(unisim_predictor* predictor, int32_t max_views,
                          unisim_window_prediction* out);

  /** Pose of the frame observed last; optional. @return UNISIM_PREDICTION_* */
  int (*frame_pose)(unisim_predictor* predictor, unisim_frame_pose* out);

  /** End of the recording: finish what runs in the background, so that last revisions can be asked
   *  for; optional. */
  int (*finish)(unisim_predictor* predictor);

  void (*info)(unisim_predictor* predictor, unisim_predictor_info* out);

  /** One line about the last REJECTED or FAILED: what, where, what to do. */
  const char* (*message)(unisim_predictor* predictor);

  /** The same for the back group; NULL: message() says it, which needs concurrent_windows 0. */
  const char* (*window_message)(unisim_predictor* predictor);

  void (*destroy)(unisim_predictor* predictor);

  /** What is followed in the frame observed last, for people to look at; optional.
   *  @param[out] features valid until the next call of a function of the front group
   *  @return their number */
  int32_t (*features)(unisim_predictor* predictor, const unisim_feature** features);

  /* Loops, for predictors without a map of their own: those that have one close them in it. Both
   *  functions or none; a table of a smaller struct_size has none, and its run has no loops. */

  /** What keyframe `id`, the newest, looks like. From this call to release_place() the predictor
   *  keeps what it needs to answer multi_view() of this keyframe together with any others that are
   *  kept: the caller holds a bounded number of them. Without the call nothing is kept.
   *  @param[out] out valid until the next call
   *  @return UNISIM_PREDICTION_OK, _REJECTED (there is nothing to see: not kept), _FAILED */
  int (*place_descriptor)(unisim_predictor* predictor, int32_t id, unisim_place_descriptor* out);

  /** No more multi_view() will ask for keyframe `id` as a place. One that is not kept: nothing. */
  void (*release_place)(unisim_predictor* predictor, int32_t id);

  /* Maps that outlive the run, for predictors with a map of their own. All four functions or none;
   *  a table of a smaller struct_size has none. */

  /** Write the map. It stays as it is; what runs in the background is not waited for.
   *  @param write called with the bytes in order, from within
   *  @return UNISIM_PREDICTION_OK; _REJECTED: there is no map yet, or `write` said 0; _FAILED */
  int (*save_map)(unisim_predictor* predictor, unisim_map_write write, void* context);

  /** Take a saved map, before the first frame. The predictor is then as one whose track was lost
   *  after the last keyframe of the map; keyframe() goes on with the number after it. What was not
   *  said of the camera is taken from the map.
   *  @param read          called for the bytes in order, from within
   *  @param[out] next_keyframe number of the next keyframe
   *  @return UNISIM_PREDICTION_OK; _REJECTED: no map, a damaged one, one of another version or
   *          camera, or larger than the configuration: message() says which part and why, and the
   *          predictor is as it was made; _FAILED */
  int (*load_map)(unisim_predictor* predictor, unisim_map_read read, void* context,
                  int32_t* next_keyframe);

  /** Where in the map a frame was taken. Nothing of the map changes, and the frame is not observed:
   *  in place of observe(), for as long as the caller likes. The time for a frame is bounded.
   *  @return UNISIM_PREDICTION_OK; _REJECTED: it is not found, or of no use; _FAILED */
  int (*locate)(unisim_predictor* predictor, const unisim_frame* frame, unisim_location* out);

  /** A keyframe of the map. @return UNISIM_PREDICTION_OK, _REJECTED (not in the map, or no pose) */
  int (*map_pose)(unisim_predictor* predictor, int32_t id, unisim_map_pose* out);
};

#ifdef __cplusplus
}
#endif

#endif
