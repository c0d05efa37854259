/* SPDX-License-Identifier: MIT */
/** @file types.h
 *  Statuses and plain values; included by unisim.h. */
#ifndef UNISIM_TYPES_H
#define UNISIM_TYPES_H

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
#define UNISIM_ERR_CAPACITY 2 /**< a declared capacity or the caller's buffer is too small */
/** The arena is smaller than unisim_arena_size() says, or that is more than this machine can
 *  address. */
#define UNISIM_ERR_OUT_OF_MEMORY 3
#define UNISIM_ERR_NOT_READY 4    /**< nothing to do or to give yet */
#define UNISIM_ERR_NUMERICAL 5    /**< no descent or not positive definite; poses stay */
#define UNISIM_ERR_INTERNAL 6     /**< broken invariant; all later calls until reset say so */
#define UNISIM_ERR_ABI_MISMATCH 7 /**< struct_size is not one this library knows */
#define UNISIM_ERR_RETIRED 8      /**< was there, and has made room for newer ones */
#define UNISIM_ERR_IO 9           /**< the caller's callback said that it could not */
#define UNISIM_ERR_DATA 10        /**< bytes handed in are not what they should be */

/** Fixed text for a status code; never NULL. */
UNISIM_API const char* unisim_status_string(unisim_status status);

/** UNISIM_VERSION_NUMBER of the library that is linked. */
UNISIM_API int32_t unisim_version(void);

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

#ifdef __cplusplus
}
#endif

#endif
