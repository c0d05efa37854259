/* SPDX-License-Identifier: MIT */
/** @file geometric.h
 *  The predictor with no model: feature tracks, epipolar geometry and bundle adjustment on one
 *  camera whose focal length and radial distortion may be unknown.
 */
#ifndef UNISIM_DRIVERS_GEOMETRIC_GEOMETRIC_H
#define UNISIM_DRIVERS_GEOMETRIC_GEOMETRIC_H

#include <stddef.h>
#include <stdint.h>

#include "drivers/predictor.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What is known of the lens. */
#define UNISIM_DISTORTION_UNKNOWN 0 /**< one radial term is estimated */
#define UNISIM_DISTORTION_PINHOLE 1 /**< OpenCV's: k1 k2 p1 p2 k3 k4 k5 k6; all 0: none */
/** OpenCV's fisheye (Kannala-Brandt, "equidistant"):
 *  k1..k4. */
#define UNISIM_DISTORTION_FISHEYE 2
#define UNISIM_DISTORTION_TERMS 8

/* How an image is read. */
#define UNISIM_SHUTTER_GLOBAL 0  /**< all rows at once */
#define UNISIM_SHUTTER_ROLLING 1 /**< one row after the other */

/** Everything a geometric predictor is made with. Its memory follows from these numbers and the
 *  size of the first image. */
typedef struct unisim_geometric_config {
  uint32_t struct_size;
  int32_t max_tracks;       /**< features followed at a time, 50..2000 (300) */
  int32_t max_keyframes;    /**< kept in the state, 32..4096 (180); then those go whose landmarks
                               others see */
  int32_t max_landmarks;    /**< kept in the state, at least 4 max_tracks (5000) */
  int32_t max_window_views; /**< views of given-out windows kept for revisions (512) */
  int32_t window_size;      /**< keyframes adjusted with each new one, 5..64 (16) */
  int32_t adjust_every;     /**< keyframes between adjustments of the whole state, more when
                               it has grown large; 0: never (10) */
  int32_t adjust_latency;   /**< keyframes after which such an adjustment is merged, more when
                               the state has grown large (4) */
  int32_t background;       /**< 1: whole-state adjustments run in a thread of their own (1) */
  int32_t revive_age;       /**< keyframes a landmark may be out of sight and be looked for (100) */
  int32_t revive_tries;     /**< landmarks looked for per keyframe (150) */
  int32_t reserved;         /**< 0 */
  double focal_px;          /**< known focal length in pixels; 0: estimate it (0) */
  unisim_image mask;        /**< GRAY8, of the frames' size: where it is 0 nothing is looked at (the
                               robot's own body, a text in the image); data NULL: look everywhere */
  int32_t places;      /**< 1: places are recognised: a lost camera is found in the map, loops are
                          closed (1) */
  int32_t loop_gap;    /**< keyframes between the two ends of a loop, at least (20) */
  int32_t loop_tries;  /**< old keyframes looked at for a loop, per second keyframe; 0: no loops
                          (3) */
  int32_t min_pnp;     /**< matched features that must agree on a pose (8) */
  int32_t min_inliers; /**< landmarks that must look there as they did (20) */
  int32_t reserved2;   /**< 0 */
  double min_share;    /**< and the share of those in view, 0..1 (0.2) */
  /* A calibrated camera: what is given holds, the rest is estimated. Where it is more than
     focal_px, images are first turned into those of an ideal camera of the same focal length,
     square pixels and the principal point in the middle: depth maps and focal lengths of
     predictions are of that image (unisim_geometric_view()), features() are places in the image
     as it came. */
  double focal_y_px;     /**< where it differs from focal_px; 0: the same (0) */
  double principal_x_px; /**< principal point, pixel centres at whole numbers; 0, 0: not known, */
  double principal_y_px; /**< the middle is taken (0) */
  int32_t distortion_model;  /**< UNISIM_DISTORTION_*; needs focal_px (0) */
  int32_t calibrated_width;  /**< image size that all of this is of; frames of the same shape may */
  int32_t calibrated_height; /**< have another: it is scaled. 0, 0: the frames' (0) */
  int32_t reserved3;         /**< 0 */
  double distortion[UNISIM_DISTORTION_TERMS]; /**< in the order of the model, the rest 0 (0) */
  int32_t shutter;   /**< UNISIM_SHUTTER_*; frames need their times (UNISIM_SHUTTER_GLOBAL) */
  int32_t reserved4; /**< 0 */
  double readout_ms; /**< of a rolling shutter: from the first row to the last, -200..200,
                        negative where the last row is read first; 0: estimate it (0) */
} unisim_geometric_config;

/** Defaults for every field.
 *  @param[out] config      struct to fill
 *  @param      struct_size sizeof(unisim_geometric_config) of the caller */
UNISIM_API void unisim_geometric_config_init(unisim_geometric_config* config, size_t struct_size);

/** Make a geometric predictor.
 *  @param[in]  config   copied, the mask's pixels too; NULL: defaults
 *  @param[out] message  one line on failure; may be NULL
 *  @param      capacity bytes of message
 *  @return NULL on failure; else free with its destroy() */
UNISIM_API unisim_predictor* unisim_geometric_create(const unisim_geometric_config* config,
                                                     char* message, size_t capacity);

/** Read a calibrated camera from a YAML file as OpenCV's calibration programs, ROS (calibration
 *  file or camera_info) and EuRoC write it.
 *  @param      path    file
 *  @param[in,out] config gets focal lengths, principal point, distortion and image size
 *  @param[out] message one line on failure; may be NULL
 *  @param      capacity bytes of message
 *  @return 1, or 0: not readable, not such a file, or values no camera has; config is unchanged */
UNISIM_API int32_t unisim_geometric_read_calibration(const char* path,
                                                     unisim_geometric_config* config, char* message,
                                                     size_t capacity);

/** Whether what is given of the camera can be that of frames of this size: their shape is the
 *  calibration's, the principal point lies in them. Creation cannot know, the first frame would.
 *  @param[out] message one line where it cannot; may be NULL
 *  @return 1, or 0 */
UNISIM_API int32_t unisim_geometric_camera_fits(const unisim_geometric_config* config,
                                                int32_t width, int32_t height, char* message,
                                                size_t capacity);

/** A frame's image as the predictor looks at it: what its depth maps and focal lengths are of. With
 *  a calibrated lens that of the ideal camera, else the image itself. To the front group of
 *  predictor.h.
 *  @param      predictor any; of another kind the image itself is given
 *  @param      image     of the frame observed last
 *  @param[out] out       of the same size; valid until the next call of the front group */
UNISIM_API void unisim_geometric_view(unisim_predictor* predictor, const unisim_image* image,
                                      unisim_image* out);

#ifdef __cplusplus
}
#endif

#endif
