// SPDX-License-Identifier: MIT
// How loops get from the search into the session.
#include "drivers/common/has_places.hpp"
#include "drivers/pipeline/map_builder.hpp"

namespace unisim::pipeline {
namespace {

/// Of the newest looks the verdict may change: a second keyframe or a window may still come.
constexpr int32_t kOpenLooks = 256;

const char* reason_of(unisim_status status, int32_t submap_id) {
  if (status == UNISIM_OK)
    return submap_id >= 0 ? nullptr : "refused by the map: its depths scatter";
  if (status == UNISIM_ERR_RETIRED) return "the map no longer holds those keyframes";
  if (status == UNISIM_ERR_CAPACITY) return "the map has no room for more loops";
  if (status == UNISIM_ERR_NOT_READY) return "a keyframe of it has no pose yet";
  return "prediction is not finite or has a wrong size";
}

}  // namespace

void MapBuilder::make_loops() {
  if (!drivers::has_places(*parts_.predictor) || parts_.loops.places < 1) return;
  loops_ = std::make_unique<LoopCloser>(parts_.loops, parts_.predictor, parts_.window_size);
}

bool MapBuilder::begin_loops() {
  unisim_session_info info{};
  if (loops_ == nullptr || parts_.session->get_info(&info) != UNISIM_OK) return false;
  // The answer may be taken some keyframes later.
  const int32_t first = info.first_keyframe > 0 ? info.first_keyframe + UNISIM_WINDOW_LAG : 0;
  return loops_->begin(last_settled_, first);
}

Step MapBuilder::serve_loops() {
  Step step = Step::kOk;
  while (step == Step::kOk && begin_loops()) {
    const ScopedLatency timer(parts_.times->loop);
    loops_->search();
    step = loops_->failure().empty() ? take_loop() : back_failed(loops_->failure());
  }
  return step;
}

Step MapBuilder::take_loop() {
  if (loops_ == nullptr || loops_->found() == nullptr) return Step::kOk;
  int32_t submap_id = -1;
  const unisim_status status = parts_.session->add_loop(*loops_->found(), &submap_id);
  const char* const refused = reason_of(status, submap_id);
  loops_->settle(refused);
  if (status == UNISIM_ERR_INTERNAL) return session_failed("unisim_add_loop", status);
  return refused == nullptr ? optimize(1) : Step::kOk;
}

/// To be called while no search runs.
void MapBuilder::tell_places() {
  unisim_predictor_info now{};
  if (loops_ != nullptr) {
    loops_->info(&now);
  } else if (lane_ == nullptr) {
    parts_.predictor->info(parts_.predictor, &now);
  }
  for (; places_told_ + kOpenLooks < now.places_past + now.place_count; ++places_told_) {
    const unisim_place_report& look = now.places[places_told_ - now.places_past];
    for (Listener* listener : *parts_.listeners) listener->on_place(look);
  }
}

void MapBuilder::info(unisim_predictor_info* out) const {
  parts_.predictor->info(parts_.predictor, out);
  if (loops_ == nullptr) return;
  loops_->finish();
  loops_->info(out);
  unisim_session_info map{};
  if (parts_.session->get_info(&map) == UNISIM_OK) out->loops_undone = map.suspended_loops;
}

}  // namespace unisim::pipeline
