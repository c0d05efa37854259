/* SPDX-License-Identifier: MIT */
/** @file onnx.h
 *  Predictors on feed-forward models in ONNX format that keep the model contract of README.md.
 *
 *  ONNX Runtime (1.21 or newer) is opened when a model is, not linked. After the models are loaded
 *  and warm nothing here takes memory from the heap; what ONNX Runtime does inside is its own.
 */
#ifndef UNISIM_DRIVERS_ONNX_ONNX_H
#define UNISIM_DRIVERS_ONNX_ONNX_H

#include <stddef.h>
#include <stdint.h>

#include "drivers/predictor.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Why something could not be opened. */
#define UNISIM_ONNX_OK 0
#define UNISIM_ONNX_BAD_CONFIG 1 /**< a field of the configuration makes no sense */
#define UNISIM_ONNX_BAD_MODEL 2  /**< the file is unreadable or breaks the contract */
#define UNISIM_ONNX_NO_RUNTIME 3 /**< library or provider absent, too old or refused */
#define UNISIM_ONNX_NOT_BUILT 5  /**< this build was made without the header of ONNX Runtime */
#define UNISIM_ONNX_NO_MEMORY 4  /**< the smallest inference does not fit the budget */

/** Everything an ONNX predictor is made with. Strings are copied. */
typedef struct unisim_onnx_config {
  uint32_t struct_size; /**< sizeof this struct */
  int32_t threads;      /**< of one inference, 0..256; 0: one per core (0) */
  int32_t memory_mb;    /**< one inference and the keyframes kept for it may take; 0: half of the
                           machine's memory (0) */
  int32_t window_size;  /**< views the caller would like in a window, 2..UNISIM_MAX_VIEWS (16) */
  int32_t keyframe_interval;  /**< advised where the caller chooses keyframes by motion: every N-th
                                 frame, 1..1000 (5) */
  int32_t reserved;           /**< 0 */
  double min_pose_confidence; /**< where a model gives one: less is rejected, 0..1 (0.75) */
  const char* model_pair;     /**< file for pairs (kind pair or multiview) */
  const char* model_window;   /**< file for windows (kind multiview); NULL: model_pair */
  const char* provider;       /**< "cpu", "cuda", "tensorrt" or what the library offers ("cpu") */
  const char* library; /**< libonnxruntime to open; NULL: environment UNISIM_ORT_LIB, the folder
                          of tools/bootstrap.sh, the system's (NULL) */
  const char* model_encoder; /**< encoder of split models; NULL: X.encoder.onnx beside X.onnx (NULL)
                              */
  const char* model_descriptor; /**< file (kind descriptor) that tells places from each other, for
                                     loops; NULL: VLAD of binary features (NULL) */
} unisim_onnx_config;

/** Defaults for every field.
 *  @param[out] config      struct to fill
 *  @param      struct_size sizeof(unisim_onnx_config) of the caller */
UNISIM_API void unisim_onnx_config_init(unisim_onnx_config* config, size_t struct_size);

/** Load the models, measure and warm them, make a predictor.
 *  @param[in]  config   copied
 *  @param[out] problem  UNISIM_ONNX_*; may be NULL
 *  @param[out] message  one line on failure: what, where, what to do; may be NULL
 *  @param      capacity bytes of message
 *  @return NULL on failure; else free with its destroy() */
UNISIM_API unisim_predictor* unisim_onnx_create(const unisim_onnx_config* config, int32_t* problem,
                                                char* message, size_t capacity);

/** Views of a window that model and memory budget allow: the session's window_size may not be
 *  larger.
 *  @param predictor of unisim_onnx_create()
 *  @return 2..config.window_size */
UNISIM_API int32_t unisim_onnx_window_size(const unisim_predictor* predictor);

/** Things worth telling once: licence, cost, a window that was made smaller.
 *  @param predictor of unisim_onnx_create()
 *  @param index     0, 1, 2 ...
 *  @return one line, NULL after the last; valid until destroy() */
UNISIM_API const char* unisim_onnx_note(const unisim_predictor* predictor, int32_t index);

/** Times that encoders of split models ran since they were loaded: once for each keyframe and
 *  encoder.
 *  @param predictor of unisim_onnx_create()
 *  @return 0 without encoder */
UNISIM_API int64_t unisim_onnx_encoder_runs(const unisim_predictor* predictor);

/** Measuring a model resets the high-water mark of the process's memory.
 *  @return the most it said before, in bytes; 0 when no model was measured */
UNISIM_API int64_t unisim_onnx_peak_before_bytes(void);

/** A model of kind descriptor: one image in, one vector of unit length out. */
typedef struct unisim_onnx_descriptor unisim_onnx_descriptor;

/** Load a descriptor model.
 *  @param[in]  config   provider, library, threads and memory count; models do not
 *  @param      path     model file
 *  @param[out] problem, message, capacity as unisim_onnx_create()
 *  @return NULL on failure; else free with unisim_onnx_descriptor_close() */
UNISIM_API unisim_onnx_descriptor* unisim_onnx_descriptor_open(const unisim_onnx_config* config,
                                                               const char* path, int32_t* problem,
                                                               char* message, size_t capacity);

/** Numbers in a descriptor. */
UNISIM_API int32_t unisim_onnx_descriptor_size(const unisim_onnx_descriptor* descriptor);

/** Describe one image.
 *  @param      descriptor live descriptor model
 *  @param[in]  image      all images of the size of the first
 *  @param[out] values     unisim_onnx_descriptor_size() floats, unit length; valid until the next
 *  call
 *  @return UNISIM_PREDICTION_OK, _REJECTED, _FAILED */
UNISIM_API int unisim_onnx_descriptor_embed(unisim_onnx_descriptor* descriptor,
                                            const unisim_image* image, const float** values);

/** One line about the last _REJECTED or _FAILED. */
UNISIM_API const char* unisim_onnx_descriptor_message(const unisim_onnx_descriptor* descriptor);

/** End it; NULL is fine. */
UNISIM_API void unisim_onnx_descriptor_close(unisim_onnx_descriptor* descriptor);

#ifdef __cplusplus
}
#endif

#endif
