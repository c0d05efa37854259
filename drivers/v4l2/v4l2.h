/* SPDX-License-Identifier: MIT */
/** @file v4l2.h
 *  Cameras of Linux as sources of frames, through the kernel's own interface and nothing else.
 *
 *  Made for tracking: of the frames that are ready the newest is given and the others are dropped,
 *  so that nothing waits in a queue. Frames are gray: GREY and NV12 are given in place, YUYV and
 *  MJPG through one buffer that is taken at opening. After opening nothing here takes memory from
 *  the heap, except OpenCV for MJPG and when a lost camera is opened again.
 *
 *  A frame's time is that of CLOCK_MONOTONIC, nanoseconds, as near to its exposure as the camera's
 *  driver says; it grows from frame to frame and is never ahead of the clock. Its index counts the
 *  frames of the camera, those lost or dropped included.
 */
#ifndef UNISIM_DRIVERS_V4L2_V4L2_H
#define UNISIM_DRIVERS_V4L2_V4L2_H

#include <stddef.h>
#include <stdint.h>

#include "drivers/source.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Why a camera could not be opened. */
#define UNISIM_V4L2_OK 0
#define UNISIM_V4L2_BAD_CONFIG 1  /**< a field of the configuration makes no sense */
#define UNISIM_V4L2_NO_CAMERA 2   /**< nothing there, or what is there is no camera of use here */
#define UNISIM_V4L2_NOT_ALLOWED 3 /**< no permission to open the device */
#define UNISIM_V4L2_BUSY 4        /**< another program has it */
#define UNISIM_V4L2_FAILED 5      /**< the device or its driver refused */

/** What is done with an automatic of the camera. */
#define UNISIM_V4L2_KEEP 0  /**< leave it as it is */
#define UNISIM_V4L2_AUTO 1  /**< the camera adjusts it */
#define UNISIM_V4L2_FIXED 2 /**< at the value given */

/** Everything a camera is opened with. Strings are copied. */
typedef struct unisim_v4l2_config {
  uint32_t struct_size; /**< sizeof this struct */
  int32_t width;        /**< pixels; the nearest size the camera offers is taken, and told (640) */
  int32_t height;       /**< (480) */
  int32_t buffers;      /**< frames the kernel fills in turn, 3..32 (4) */
  double fps;           /**< frames per second, 1..1000; the nearest rate is taken (30) */
  const char* device;   /**< path, number N of /dev/videoN, or bus name as unisim_v4l2_list() shows
                           it;   NULL: the first camera (NULL) */
  const char* pixel_format; /**< "GREY", "YUYV", "NV12", "MJPG"; NULL or "auto": an uncompressed one
                               if it comes at this size and rate, else MJPG (NULL) */
  int32_t exposure;         /**< UNISIM_V4L2_KEEP, _AUTO or _FIXED (KEEP) */
  int32_t exposure_us;      /**< exposure time where fixed, microseconds; 0: that of now (0) */
  int32_t constant_rate; /**< 1: automatic exposure may not lower the frame rate; 0: as it is (1) */
  int32_t focus;         /**< UNISIM_V4L2_KEEP, _AUTO or _FIXED (KEEP) */
  int32_t focus_position;   /**< where fixed, in the camera's own unit; -1: that of now (-1) */
  int32_t power_line_hz;    /**< against flicker of lamps: 50, 60; -1: off; 0: as it is (0) */
  int32_t frame_timeout_ms; /**< without a frame for so long the stream is started anew, 10..600000
                               (2000) */
  int32_t reconnect_ms;     /**< a lost camera is waited for so long, 0..86400000; 0: it is not
                               (30000) */
} unisim_v4l2_config;

/** Defaults for every field.
 *  @param[out] config      struct to fill
 *  @param      struct_size sizeof(unisim_v4l2_config) of the caller */
UNISIM_API void unisim_v4l2_config_init(unisim_v4l2_config* config, size_t struct_size);

/** Open a camera and start it.
 *
 *  next_frame() waits for a frame. It gives UNISIM_FRAME_BAD for a frame that came damaged, when
 *  the camera was lost and when it is back: message() is one line each, and the next call goes on.
 *  UNISIM_FRAME_FAILED: the camera did not come back in time or fails again and again.
 *  interrupt() ends a wait. destroy() puts the controls back as they were found.
 *
 *  @param[in]  config       copied; NULL: defaults
 *  @param[out] problem      UNISIM_V4L2_*; may be NULL
 *  @param[out] message      on failure one line: what, where, what to do; may be NULL
 *  @param      message_size bytes of message
 *  @return the source, to be freed with its destroy(); NULL on failure */
UNISIM_API unisim_source* unisim_v4l2_open(const unisim_v4l2_config* config, int32_t* problem,
                                           char* message, size_t message_size);

/** What came of the configuration at opening. */
typedef struct unisim_v4l2_mode {
  uint32_t struct_size;
  int32_t width; /**< pixels of every frame */
  int32_t height;
  int32_t reserved;
  double fps;           /**< as the driver says; 0: it does not */
  char pixel_format[8]; /**< "GREY", "YUYV", "NV12", "MJPG" */
  char device[64];      /**< path it was opened by first */
  char card[32];        /**< name of the camera */
  char bus[32];         /**< where it is plugged in; by this it is found again */
} unisim_v4l2_mode;

/** @param      source of unisim_v4l2_open()
 *  @param[out] mode   struct_size is the caller's, the rest is filled in as far as it reaches */
UNISIM_API void unisim_v4l2_get_mode(const unisim_source* source, unisim_v4l2_mode* mode);

/** What was noticed at opening and does not stop a run, such as a size or rate the driver changed.
 *  @param source of unisim_v4l2_open()
 *  @param index  0, 1, 2 ...
 *  @return one line owned by the source, NULL past the last */
UNISIM_API const char* unisim_v4l2_note(const unisim_source* source, int32_t index);

/** What has been counted since opening. */
typedef struct unisim_v4l2_statistics {
  uint32_t struct_size;
  int32_t reserved;
  int64_t frames;     /**< given to the caller */
  int64_t lost;       /**< never came, by gaps in the camera's count */
  int64_t superseded; /**< dropped here because a newer one was ready */
  int64_t errors;     /**< flagged as damaged by the camera's driver */
  int64_t bad;        /**< short, stale, or no image of the right kind */
  int64_t restamped;  /**< their time stamp was of no use and replaced */
  int64_t restarts;   /**< stream started anew, the camera being there */
  int64_t reconnects; /**< camera found again after it was unplugged */
} unisim_v4l2_statistics;

/** From any thread at any time.
 *  @param      source     of unisim_v4l2_open()
 *  @param[out] statistics struct_size is the caller's, the rest is filled in as far as it reaches
 */
UNISIM_API void unisim_v4l2_get_statistics(const unisim_source* source,
                                           unisim_v4l2_statistics* statistics);

/** The cameras of this machine as a table for people: device, name and bus of each, under it the
 *  formats of use here with their sizes and highest rates. A device that cannot be looked at has a
 *  line that says why.
 *  @param[out] table    text of whole lines, as many as fit; may be NULL
 *  @param      capacity bytes of table
 *  @param[out] needed   bytes that the whole table takes, its end included; may be NULL
 *  @return number of cameras */
UNISIM_API int32_t unisim_v4l2_list(char* table, size_t capacity, size_t* needed);

#ifdef __cplusplus
}
#endif

#endif
