// SPDX-License-Identifier: MIT
// The keyframes that a predictor keeps for loops.
#include "drivers/pipeline/place_book.hpp"

#include <algorithm>
#include <cstdlib>

namespace unisim::pipeline {

PlaceBook::PlaceBook(unisim_predictor* predictor, int32_t capacity, int32_t dimension)
    : predictor_(predictor), places_(capacity, dimension) {
  ids_.reserve(static_cast<size_t>(capacity) + 1);
}

void PlaceBook::add(int32_t id, const int8_t* descriptor) {
  int32_t evicted = -1;
  if (!places_.add(id, descriptor, &evicted)) {
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
    places_.remove(ids_.front());
    release(ids_.front());
  }
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
  return places_.bytes() + static_cast<int64_t>(ids_.capacity() * sizeof(int32_t));
}

}  // namespace unisim::pipeline
