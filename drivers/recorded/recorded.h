/* SPDX-License-Identifier: MIT */
/** @file recorded.h
 *  Predictions stored in one file and given out again. The file's format is in README.md.
 *
 *  A run through a recorder and a run of the file it wrote give a session the same calls with the
 *  same numbers, so the same poses bit for bit.
 */
#ifndef UNISIM_DRIVERS_RECORDED_RECORDED_H
#define UNISIM_DRIVERS_RECORDED_RECORDED_H

#include <stddef.h>

#include "drivers/predictor.h"

#ifdef __cplusplus
extern "C" {
#endif

/** A predictor that hands every call on to another one and stores the answers. Each record is in
 *  the file when the call that made it returns; destroy() closes the file. When the file cannot be
 *  written any more (full disk) recording stops, what is written stays readable, the run goes on
 *  and unisim_recorder_problem() says so.
 *  @param inner         owned from now on, destroyed with the recorder; on failure still the
 *  caller's
 *  @param path          file to make; one that exists is replaced
 *  @param sequence_name stored in the file; may be NULL
 *  @param message       one line on failure: what, where, what to do; may be NULL
 *  @param message_size  bytes of message
 *  @return the recorder, NULL when the file cannot be made; its name and needs_images are inner's
 */
UNISIM_API unisim_predictor* unisim_recorder_create(unisim_predictor* inner, const char* path,
                                                    const char* sequence_name, char* message,
                                                    size_t message_size);

/** Why recording stopped.
 *  @param recorder of unisim_recorder_create()
 *  @return one line, "" while all is well; valid until destroy() */
UNISIM_API const char* unisim_recorder_problem(const unisim_predictor* recorder);

/** A predictor that gives the predictions of a file, with no images and no model. Only where the
 *  file names neither frames nor keyframes needs_images is 1: which images could be read then
 *  decides which are keyframes. Where the file names its keyframes, observe() sets keyframe_advice
 *  to 1 or -1; a pair or window is PENDING until the moment it was answered in the recording and
 *  REJECTED when the file does not hold it. Memory: a few words per record and one record.
 *  @param path         file written by a recorder or by tools/export/unisim_record.py
 *  @param message      one line: the reason on failure; on success a note about a recording that
 *  was cut off, else ""; may be NULL
 *  @param message_size bytes of message
 *  @return the predictor, NULL when the file is unreadable, damaged or of a newer version */
UNISIM_API unisim_predictor* unisim_recorded_open(const char* path, char* message,
                                                  size_t message_size);

/** How the windows of a recording follow each other: a session asks for the same ones when its
 *  window_size and window_overlap are these.
 *  @param recorded of unisim_recorded_open()
 *  @param[out] size, overlap keyframes
 *  @return 1; 0 when the file holds fewer than two windows and does not tell */
UNISIM_API int unisim_recorded_windows(const unisim_predictor* recorded, int32_t* size,
                                       int32_t* overlap);

/** Name of the predictor that made the answers in the first place: for a recording the one that was
 *  recorded, through a recorder that of the predictor inside, else the predictor's own name.
 *  @param predictor any predictor
 *  @return "geometric", ...; "" where a file does not say; valid until the predictor's destroy() */
UNISIM_API const char* unisim_predictor_origin(const unisim_predictor* predictor);

/** The predictor inside a recorder, or in recorders one in another; any other is itself. For
 *  functions that one kind of predictor has beside its table. It stays the recorder's. */
UNISIM_API unisim_predictor* unisim_predictor_inside(unisim_predictor* predictor);

/** Size of the images a recording was made from, which need not be there any more.
 *  @param predictor any predictor; through a recorder the one inside
 *  @param[out] width, height pixels
 *  @return 1; 0 for what is no recording and for a file that does not say */
int unisim_predictor_recorded_size(const unisim_predictor* predictor, int32_t* width,
                                   int32_t* height);

#ifdef __cplusplus
}
#endif

#endif
