/* SPDX-License-Identifier: MIT */
/** @file snapshot.h
 *  A map that outlives the run: saved and loaded through callbacks; included by unisim.h.
 *
 *      static int32_t to_file(void* file, const void* bytes, size_t size) {
 *        return fwrite(bytes, size, 1, (FILE*)file) == 1;
 *      }
 *      static int32_t from_file(void* file, void* bytes, size_t size) {
 *        return fread(bytes, size, 1, (FILE*)file) == 1;
 *      }
 *      status = unisim_save_map(session, to_file, file);
 *      status = unisim_load_map(next_session, from_file, file); */
#ifndef UNISIM_SNAPSHOT_H
#define UNISIM_SNAPSHOT_H

#include "unisim/config.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Takes the next bytes of a snapshot; may not call the session.
 *  @param context as handed to the call
 *  @param bytes   valid during the call
 *  @param size    how many, 1..512
 *  @return 1 when they are taken, 0 when not: the snapshot ends there */
typedef int32_t (*unisim_write_fn)(void* context, const void* bytes, size_t size);

/** Gives the next bytes of a snapshot; may not call the session.
 *  @param context as handed to the call
 *  @param[out] bytes all of them are filled
 *  @param      size  how many, 1..512
 *  @return 1 when they are, 0 when there are fewer left, or reading failed */
typedef int32_t (*unisim_read_fn)(void* context, void* bytes, size_t size);

/** Save the map: everything a session needs to go on as if it had not been interrupted. Nothing of
 *  the map changes; only the solver starts anew at the next unisim_optimize(), as that of a session
 *  that loads the snapshot does, so that both go on with the same bits. Later poses differ in their
 *  last digits from those of a session that was not saved.
 *
 *  The bytes are the same on every machine. They can be part of a larger file: the snapshot knows
 *  where it ends. Its size depends on what the map holds: with a callback that only counts, the
 *  call says how much.
 *  @param session live session
 *  @param      write   called for all of the snapshot, piece by piece
 *  @param      context handed to it
 *  @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT (NULL), UNISIM_ERR_IO when write() said 0 */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_save_map(const unisim_session* session,
                                                          unisim_write_fn write, void* context);

/** Load a map that unisim_save_map() wrote, into a session without keyframes.
 *
 *  The configuration must have the preset and the depth grid of the session that saved, and a
 *  sliding window if that had one. Its window_size, window_overlap, window_submaps and
 *  skeleton_capacity must be as large, its other capacities large enough for what is there: those
 *  of the session that saved always are. Weights, gates and iterations are its own.
 *
 *  Then keyframe ids go on, old keyframes can be read and named by loops, open requests are open
 *  again. Time stamps of new keyframes may be smaller than old ones. A run that does not go on
 *  where the saved one ended rejects the open requests: its first pair begins a new segment, which
 *  a loop joins to the map.
 *
 *  Everything is checked before it is used. On error the session is as after
 *  unisim_session_reset() and unisim_get_load_report() says what was wrong.
 *  @param session live session without keyframes
 *  @param      read    called for all of the snapshot and not beyond its end
 *  @param      context handed to it
 *  @return UNISIM_OK; UNISIM_ERR_INVALID_ARGUMENT (NULL, the session has keyframes); UNISIM_ERR_IO
 *          when read() said 0; UNISIM_ERR_DATA (no snapshot, damaged, of a later version);
 *          UNISIM_ERR_CAPACITY (a number of the configuration is too small or another one) */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_load_map(unisim_session* session,
                                                          unisim_read_fn read, void* context);

/** Why a snapshot was not loaded. */
#define UNISIM_LOAD_OK 0       /**< it was, or none has been tried */
#define UNISIM_LOAD_END 1      /**< the callback said 0: it is cut, or reading failed */
#define UNISIM_LOAD_MAGIC 2    /**< it is no snapshot */
#define UNISIM_LOAD_VERSION 3  /**< a later version of the library wrote it */
#define UNISIM_LOAD_CHECKSUM 4 /**< it is damaged */
#define UNISIM_LOAD_CONTENT 5  /**< it is damaged or made up: no map has such numbers */
#define UNISIM_LOAD_CAPACITY 6 /**< a number of the configuration is too small */
#define UNISIM_LOAD_SETTING 7  /**< a setting of the configuration is another one */

/** What the last unisim_load_map() of a session found; none since create or reset: UNISIM_LOAD_OK.
 */
typedef struct unisim_load_report {
  uint32_t struct_size; /**< sizeof this struct, set by the caller */
  int32_t problem;      /**< UNISIM_LOAD_* */
  char section[16];     /**< part of the snapshot in which it was found, zero-ended */
  char setting[32];     /**< field of unisim_config for UNISIM_LOAD_CAPACITY and _SETTING,
                             zero-ended, else empty */
  int64_t needed; /**< value of that field with which it could go on; a later part may need more of
                       another */
  int64_t given;  /**< its value in this session, or what follows from it */
} unisim_load_report;

/** Read that report.
 *  @param session live session
 *  @param[out] report filled on success
 *  @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT, UNISIM_ERR_ABI_MISMATCH */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_get_load_report(const unisim_session* session,
                                                                 unisim_load_report* report);

#ifdef __cplusplus
}
#endif

#endif
