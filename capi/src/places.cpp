// SPDX-License-Identifier: MIT
// The index of places: argument checks and calls into core.
#include "unisim/places.h"

#include "capi/src/read_write.hpp"
#include "capi/src/struct_size.hpp"
#include "core/map/place_index.hpp"

using unisim::Arena;
using unisim::PlaceIndex;
using unisim::PlaceIndexConfig;
using unisim::PlaceMatch;
using unisim::Status;
using unisim::to_c;

static_assert(sizeof(unisim_places_match) == sizeof(PlaceMatch) &&
                  offsetof(unisim_places_match, score) == offsetof(PlaceMatch, score),
              "matches are written in place");

namespace {

constexpr int32_t kMostMatches = PlaceIndex::kMaxCapacity;

PlaceIndex* core(unisim_places* places) { return reinterpret_cast<PlaceIndex*>(places); }

bool is_live(unisim_places* places) { return places != nullptr && core(places)->live(); }

unisim_places_config defaults() {
  const PlaceIndexConfig ours;
  unisim_places_config config = {};
  config.struct_size = sizeof config;
  config.capacity = ours.capacity;
  config.dimension = ours.dimension;
  config.same_place = ours.same_place;
  return config;
}

unisim_status read_config(const unisim_places_config* from, PlaceIndexConfig* to) {
  unisim_places_config config = defaults();
  const unisim_status status = unisim::read_struct(from, &config);
  if (status != UNISIM_OK) return status;
  *to = {config.capacity, config.dimension, config.same_place};
  return config.reserved == 0 && PlaceIndex::valid(*to) ? UNISIM_OK : UNISIM_ERR_INVALID_ARGUMENT;
}

}  // namespace

unisim_status unisim_places_config_init(unisim_places_config* config, size_t struct_size) {
  if (config == nullptr) return UNISIM_ERR_INVALID_ARGUMENT;
  if (!unisim::is_size_of<unisim_places_config>(struct_size)) return UNISIM_ERR_ABI_MISMATCH;
  unisim::write_struct(defaults(), struct_size, config);
  return UNISIM_OK;
}

unisim_status unisim_places_arena_size(const unisim_places_config* config, size_t* size) {
  if (size == nullptr) return UNISIM_ERR_INVALID_ARGUMENT;
  PlaceIndexConfig checked;
  const unisim_status status = read_config(config, &checked);
  if (status != UNISIM_OK) return status;
  const Arena arena = PlaceIndex::measure(checked);
  if (!arena.ok()) return UNISIM_ERR_OUT_OF_MEMORY;
  *size = arena.required_bytes();
  return UNISIM_OK;
}

unisim_status unisim_places_create(unisim_places** places, const unisim_places_config* config,
                                   void* arena, size_t size) {
  if (places == nullptr || arena == nullptr) return UNISIM_ERR_INVALID_ARGUMENT;
  PlaceIndexConfig checked;
  const unisim_status status = read_config(config, &checked);
  if (status != UNISIM_OK) return status;
  PlaceIndex* made = nullptr;
  const Status created = PlaceIndex::create(checked, arena, size, &made);
  if (created == Status::kOk) *places = reinterpret_cast<unisim_places*>(made);
  return to_c(created);
}

void unisim_places_destroy(unisim_places* places) {
  if (is_live(places)) core(places)->end();
}

unisim_status unisim_places_add(unisim_places* places, int32_t id, const int8_t* descriptor,
                                int32_t* evicted) {
  if (!is_live(places) || descriptor == nullptr || id < 0) return UNISIM_ERR_INVALID_ARGUMENT;
  int32_t gone = -1;
  const Status status = core(places)->add(id, descriptor, &gone);
  if (status == Status::kOk && evicted != nullptr) *evicted = gone;
  return to_c(status);
}

unisim_status unisim_places_remove(unisim_places* places, int32_t id) {
  return is_live(places) ? to_c(core(places)->remove(id)) : UNISIM_ERR_INVALID_ARGUMENT;
}

unisim_status unisim_places_query(unisim_places* places, const unisim_places_question* question,
                                  unisim_places_match* matches, int32_t capacity, int32_t* count) {
  if (!is_live(places)) return UNISIM_ERR_INVALID_ARGUMENT;
  unisim_places_question q = {};
  const unisim_status status = unisim::read_struct(question, &q);
  if (status != UNISIM_OK) return status;
  const bool good = matches != nullptr && count != nullptr && capacity >= 1 &&
                    capacity <= kMostMatches && q.descriptor != nullptr && q.gap >= 0 &&
                    q.spread >= 0 && core(places)->good(q.descriptor);
  if (!good) return UNISIM_ERR_INVALID_ARGUMENT;
  *count = core(places)->query({q.descriptor, q.id, q.gap, q.spread},
                               {reinterpret_cast<PlaceMatch*>(matches), capacity});
  return UNISIM_OK;
}
