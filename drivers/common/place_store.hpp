// SPDX-License-Identifier: MIT
// unisim/places.h in memory of its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <vector>

#include "unisim/places.h"

namespace unisim::drivers {

class PlaceStore {
 public:
  /// @throws std::bad_alloc
  PlaceStore(int32_t capacity, int32_t dimension) {
    unisim_places_config config;
    if (unisim_places_config_init(&config, sizeof config) != UNISIM_OK) throw std::bad_alloc();
    config.capacity = capacity;
    config.dimension = dimension;
    if (unisim_places_arena_size(&config, &arena_bytes_) != UNISIM_OK) throw std::bad_alloc();
    arena_.reset(new char[arena_bytes_]);
    if (unisim_places_create(&places_, &config, arena_.get(), arena_bytes_) != UNISIM_OK) {
      throw std::bad_alloc();
    }
  }
  ~PlaceStore() { unisim_places_destroy(places_); }
  PlaceStore(const PlaceStore&) = delete;
  PlaceStore& operator=(const PlaceStore&) = delete;

  /// @param[out] evicted the place that made room, -1 for none; may be NULL
  /// @return false: not kept, see unisim_places_add()
  bool add(int32_t id, const int8_t* descriptor, int32_t* evicted = nullptr) {
    return unisim_places_add(places_, id, descriptor, evicted) == UNISIM_OK;
  }
  /// One that is not there: nothing.
  void remove(int32_t id) { static_cast<void>(unisim_places_remove(places_, id) == UNISIM_OK); }
  /// The places most like a descriptor, best first. @param question but for struct_size
  const std::vector<unisim_places_match>& query(unisim_places_question question, int32_t most) {
    question.struct_size = sizeof question;
    matches_.resize(static_cast<size_t>(most));
    int32_t count = 0;
    if (unisim_places_query(places_, &question, matches_.data(), most, &count) != UNISIM_OK) {
      count = 0;
    }
    matches_.resize(static_cast<size_t>(count));
    return matches_;
  }
  int64_t bytes() const { return static_cast<int64_t>(arena_bytes_); }

 private:
  size_t arena_bytes_ = 0;
  std::unique_ptr<char[]> arena_;
  unisim_places* places_ = nullptr;
  std::vector<unisim_places_match> matches_;
};

}  // namespace unisim::drivers
