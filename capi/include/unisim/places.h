/* SPDX-License-Identifier: MIT */
/** @file places.h
 *  Index of places: descriptors of keyframes, and those most like a given one.
 *
 *  An object of its own beside the session, in memory stated at creation. It orders candidates and
 *  decides nothing: whether two keyframes show one place is for a predictor to verify. The rules of
 *  unisim.h on structs, pointers, threads and errors hold here too. */
#ifndef UNISIM_PLACES_H
#define UNISIM_PLACES_H

#include "unisim/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Everything an index is made with. Fill with unisim_places_config_init(), then edit. */
typedef struct unisim_places_config {
  uint32_t struct_size; /**< sizeof this struct, set by the caller */
  int32_t capacity;     /**< places kept, 1..1000000 (1024) */
  int32_t dimension;    /**< numbers of a descriptor, 1..65536; (capacity + 1) dimension must stay
                             below 2^31 (1024) */
  int32_t reserved;     /**< 0 */
  double same_place;    /**< cosine of two descriptors from which one of them may make room for a
                             newer entry, 0..1 (0.4) */
} unisim_places_config;

/** Defaults for every field.
 *  @param[out] config      struct to fill
 *  @param      struct_size sizeof(unisim_places_config) of the caller
 *  @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT on NULL, UNISIM_ERR_ABI_MISMATCH */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_places_config_init(unisim_places_config* config,
                                                                    size_t struct_size);

/** Exact bytes an index with this configuration needs, alignment slack included.
 *  @param[in]  config ranges as stated at the fields
 *  @param[out] size   bytes
 *  @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT, UNISIM_ERR_OUT_OF_MEMORY (more than this machine
 *          can address), UNISIM_ERR_ABI_MISMATCH */
UNISIM_API UNISIM_NODISCARD unisim_status
unisim_places_arena_size(const unisim_places_config* config, size_t* size);

/** An index. All its bytes lie in the arena. */
typedef struct unisim_places unisim_places;

/** Make an index in the caller's memory; nothing is asked of the system here or later.
 *  @param[out] places set on success
 *  @param[in]  config copied
 *  @param[in]  arena  caller's, any alignment, kept until unisim_places_destroy()
 *  @param      size   bytes of arena, at least unisim_places_arena_size()
 *  @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT, UNISIM_ERR_OUT_OF_MEMORY,
 *          UNISIM_ERR_ABI_MISMATCH */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_places_create(unisim_places** places,
                                                               const unisim_places_config* config,
                                                               void* arena, size_t size);

/** End an index; the arena is the caller's again. NULL is fine. */
UNISIM_API void unisim_places_destroy(unisim_places* places);

/** Append the descriptor of a keyframe.
 *
 *  When the index is full, the older of the two entries that are most alike goes. An entry that is
 *  the only view of a place never does: when no two are as alike as unisim_places_config.same_place
 *  the new one is refused. Time grows with the number of entries.
 *  @param places live index
 *  @param      id         not negative, larger than all that were added before
 *  @param[in]  descriptor unisim_places_config.dimension numbers of -127..127, not all 0
 *  @param[out] evicted    id of the entry that made room, -1 for none; may be NULL
 *  @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT, UNISIM_ERR_CAPACITY (full, and none may go) */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_places_add(unisim_places* places, int32_t id,
                                                            const int8_t* descriptor,
                                                            int32_t* evicted);

/** Take an entry out.
 *  @param places live index
 *  @param id     as it was added with
 *  @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT when there is none of this id */
UNISIM_API UNISIM_NODISCARD unisim_status unisim_places_remove(unisim_places* places, int32_t id);

/** What to look for. */
typedef struct unisim_places_question {
  uint32_t struct_size;     /**< sizeof this struct, set by the caller */
  int32_t id;               /**< of the descriptor, whether it was added or not */
  int32_t gap;              /**< ids of matches differ by at least so much from `id`; 0: any */
  int32_t spread;           /**< and by so much from each other, so that neighbours, which show the
                                 same, do not take each other's tries; 0 or 1: any */
  const int8_t* descriptor; /**< as for unisim_places_add() */
} unisim_places_question;

/** An entry that is like the descriptor asked for. */
typedef struct unisim_places_match {
  int32_t id;    /**< as it was added with */
  int32_t score; /**< dot product of the two descriptors */
} unisim_places_match;

/** The entries most like a descriptor: exact, best first, equal scores by id. Each is the best of
 *  those that are far enough from the query and from all before it.
 *  @param places live index; nothing that can be asked for changes
 *  @param[in]  question see unisim_places_question
 *  @param[out] matches  caller's array
 *  @param      capacity its length, 1..1000000
 *  @param[out] count    matches written
 *  @return UNISIM_OK (with a count of 0 too), UNISIM_ERR_INVALID_ARGUMENT,
 *          UNISIM_ERR_ABI_MISMATCH */
UNISIM_API UNISIM_NODISCARD unisim_status
unisim_places_query(unisim_places* places, const unisim_places_question* question,
                    unisim_places_match* matches, int32_t capacity, int32_t* count);

#ifdef __cplusplus
}
#endif

#endif
