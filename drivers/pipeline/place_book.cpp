// SPDX-License-Identifier: MIT
// The keyframes that a predictor keeps for loops.
#include "drivers/pipeline/place_book.hpp"

#include <algorithm>
#include <cstdlib>
#include <new>

namespace unisim::pipeline {

PlaceBook::PlaceBook(unisim_predictor* predictor, int32_t capacity, int32_t dimension)
    : predictor_(predictor) {
  unisim_places_config config;
  if (unisim_places_config_init(&config, sizeof config) != UNISIM_OK) throw std::bad_alloc();
  config.capacity = capacity;
  config.dimension = dimension;
  if (unisim_places_arena_size(&config, &arena_bytes_) != UNISIM_OK) throw std::bad_alloc();
  arena_.reset(new char[arena_bytes_]);
  if (unisim_places_create(&places_, &config, arena_.get(), arena_bytes_) != UNISIM_OK) {
    throw std::bad_alloc();
  }
  ids_.reserve(static_cast<size_t>(capacity) + 1);
}

void PlaceBook::add(int32_t id, const int8_t* descriptor) {
  int32_t evicted = -1;
  if (unisim_places_add(places_, id, descriptor, &evicted) != UNISIM_OK) {
    predictor_->release_place(predictor_, id);
    return;
  }
  ids_.push_back(id);
  if (evicted >= 0) release(evicted);
}

void PlaceBook::release(int32_t id) {
  ids_.erase(std::lower_bound(ids_.begin(), ids_.end(), id));
  predictor_->release_place(predictor_, id);
}

void PlaceBook::forget_before(int32_t first) {
  while (!ids_.empty() && ids_.front() < first) {
    static_cast<void>(unisim_places_remove(places_, ids_.front()) == UNISIM_OK);
    release(ids_.front());
  }
}

const std::vector<unisim_places_match>& PlaceBook::query(const unisim_places_question& question,
                                                         int32_t most) {
  matches_.resize(static_cast<size_t>(most));
  int32_t count = 0;
  if (unisim_places_query(places_, &question, matches_.data(), most, &count) != UNISIM_OK) {
    count = 0;
  }
  matches_.resize(static_cast<size_t>(count));
  return matches_;
}

std::vector<int32_t> PlaceBook::around(int32_t id, int32_t most, int32_t reach,
                                       int32_t newest) const {
  const auto first = std::lower_bound(ids_.begin(), ids_.end(), id - reach);
  const auto last = std::upper_bound(first, ids_.end(), std::min(id + reach, newest));
  std::vector<int32_t> found(first, last);
  std::stable_sort(found.begin(), found.end(),
                   [id](int32_t a, int32_t b) { return std::abs(a - id) < std::abs(b - id); });
  if (found.size() > static_cast<size_t>(most)) found.resize(static_cast<size_t>(most));
  std::sort(found.begin(), found.end());
  return found;
}

int64_t PlaceBook::bytes() const {
  return static_cast<int64_t>(arena_bytes_ + ids_.capacity() * sizeof(int32_t));
}

}  // namespace unisim::pipeline
