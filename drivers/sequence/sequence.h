/* SPDX-License-Identifier: MIT */
/** @file sequence.h  Opens a recorded sequence of images as a source of frames.
 *
 *  | format  | what it is                                                                     |
 *  |---------|--------------------------------------------------------------------------------|
 *  | tum     | folder with rgb.txt or associations.txt; groundtruth.txt                       |
 *  | 7scenes | folder with frame-NNNNNN.color.png or .jpg, or above it (seq-NN); *.pose.txt   |
 *  | euroc   | folder with mav0/cam0/data.csv and data/; state_groundtruth_estimate0/data.csv |
 *  | kitti   | odometry root with one sequence, or sequences/NN; times.txt; poses/NN.txt      |
 *  | replica | folder with results/frame*.jpg and traj.txt                                    |
 *  | images  | folder of images, or a pattern with * and ?; in natural order                  |
 *  | lcm     | LCM event log with bot_core.image_t: GRAY, RGB, BGR, YUYV or MJPEG             |
 *  | video   | any file OpenCV can play                                                       |
 *
 *  A camera does not turn its sensor on the way: the EXIF orientation of the first readable image
 *  holds for all of them. 16-bit images that use 8, 10, 12 or 14 bits (judged by eight of them,
 *  spread over the range asked for) are reduced to 8 bits from these. 16-bit gray images with
 *  "depth" in the name of file or folder are refused. Videos are turned as their file says, and
 *  stretched where their pixels are not square.
 *
 *  Lists of images are sorted by time; seconds, milli-, micro- and nanoseconds are told apart by
 *  the steps. Where a format has no times, that of an image is its number at the frame rate: an
 *  image that is missing is a gap in time. Names that begin with a dot are no input.
 */
#ifndef UNISIM_DRIVERS_REPLAY_SEQUENCE_H
#define UNISIM_DRIVERS_REPLAY_SEQUENCE_H

#include <stddef.h>
#include <stdint.h>

#include "drivers/source.h"

#ifdef __cplusplus
extern "C" {
#endif

/** How to open a sequence. All zero but struct_size is a good default. */
typedef struct unisim_sequence_options {
  uint32_t struct_size;
  int32_t reserved;    /**< 0 */
  const char* format;  /**< a format of the table above; NULL or "auto": recognised by content */
  int64_t from;        /**< first frame, by position among those that are there */
  int64_t to;          /**< one past the last frame; <= 0: to the end */
  double fps;          /**< frames per second where the format carries no times; 0: its usual rate
                            (30; KITTI 10) */
  const char* channel; /**< of an LCM log; NULL or "": UNISIM_IMAGE, or the only one with images */
} unisim_sequence_options;

/** Open a recorded sequence. The list of files and the ground truth are read here, once; images are
 *  decoded one by one into a buffer that is used again.
 *
 *  A frame is UNISIM_FRAME_BAD when its file is missing, empty, truncated or not an image, or when
 *  its size differs from that of the first good frame. Of images with the same time the first is
 *  taken; a list where so most images would be left out is refused.
 *
 *  @param[in]  path         folder, pattern or file
 *  @param[in]  options      NULL: defaults
 *  @param[out] message      on failure one line: what, where, what to do; may be NULL
 *  @param      message_size bytes of message
 *  @return the source, to be freed with its destroy(); NULL on failure */
UNISIM_API unisim_source* unisim_sequence_open(const char* path,
                                               const unisim_sequence_options* options,
                                               char* message, size_t message_size);

/** What was noticed at opening and does not stop a run, such as lines left out of a list.
 *  @param source one that unisim_sequence_open() gave
 *  @param i      0, 1, ...
 *  @return one line owned by the source, NULL past the last */
UNISIM_API const char* unisim_sequence_note(const unisim_source* source, int32_t i);

/** File of the frame that next_frame() gave last: of a video always the video.
 *  @param source one that unisim_sequence_open() gave
 *  @return owned by the source, valid until its next call; "" before the first frame */
UNISIM_API const char* unisim_sequence_frame_path(const unisim_source* source);

/** What is done to stored pixels, the same for every frame. */
typedef struct unisim_sequence_pixels {
  uint32_t struct_size;
  int32_t orientation; /**< images are turned as EXIF says for 1 to 8; 1: not at all. Videos: 1,
                          they come turned */
  int32_t bits;        /**< how many of 16-bit pixels are used: 8, 10, 12, 14 or 16 */
  int32_t width;       /**< frames of a video are stretched to this size; 0: they are not */
  int32_t height;
} unisim_sequence_pixels;

/** @param      source one that unisim_sequence_open() gave
 *  @param[out] pixels struct_size is the caller's, the rest is filled in as far as it reaches */
UNISIM_API void unisim_sequence_get_pixels(const unisim_source* source,
                                           unisim_sequence_pixels* pixels);

#ifdef __cplusplus
}
#endif

#endif
