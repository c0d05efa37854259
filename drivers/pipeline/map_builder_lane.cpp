// SPDX-License-Identifier: MIT
// When windows are asked for on the lane beside the tracking, and when their answers are taken.
#include <algorithm>
#include <chrono>

#include "drivers/pipeline/map_builder.hpp"

namespace unisim::pipeline {
namespace {

bool same_window(const unisim_request& a, const unisim_request& b) {
  return a.count == b.count && a.keyframe_ids[0] == b.keyframe_ids[0];
}

}  // namespace

Step MapBuilder::serve_back() {
  if (lane_ == nullptr) {
    Step step = serve_windows();
    if (step == Step::kOk) step = serve_revisions();
    if (step == Step::kOk) step = serve_wide_windows();
    if (step == Step::kOk) step = serve_loops();
    tell_places();
    return step;
  }
  if (lane_->busy() && !turn_is_due()) return Step::kOk;
  const Step step = lane_->busy() ? end_turn() : Step::kOk;
  tell_places();
  if (step == Step::kOk) begin_turn();
  return step;
}

/// By counts, so that a replay is the same twice; a robot takes what is there. A turn with no
/// window in it makes no window wait: a predictor that could say more and does not has the same
/// result as one that cannot.
bool MapBuilder::turn_is_due() {
  if (parts_.realtime) return lane_->answered();
  unisim_request window;
  return newest_ >= asked_at_ + report_.lag ||
         (asked_.count == 0 && next_request(UNISIM_REQUEST_WINDOW, &window));
}

void MapBuilder::begin_turn() {
  const bool wanted = drop_oldest_windows(&asked_);
  const bool wide = wants_wide_window();
  // A window is taken first: what a search finds would be written over it.
  const bool loops = !wanted && begin_loops();
  if (!wanted && !wide && !loops && parts_.predictor->next_revision == nullptr) return;
  if (wanted)
    ++report_.asked;
  else
    asked_.count = 0;
  asked_at_ = newest_;
  lane_->ask(wanted ? &asked_ : nullptr, wide, loops);
}

/// The window to ask for next. In a realtime run a predictor that is behind does not catch up by
/// itself: more than kMostWaiting do not wait, the newest stay.
/// @return false when none is open
bool MapBuilder::drop_oldest_windows(unisim_request* oldest) {
  while (next_request(UNISIM_REQUEST_WINDOW, oldest)) {
    const int32_t last = oldest->keyframe_ids[oldest->count - 1];
    const int32_t waiting = 1 + (last_settled_ - last) / parts_.window_step;
    report_.most_waiting = std::max(report_.most_waiting, waiting);
    if (!parts_.realtime || waiting <= kMostWaiting) return true;
    ++report_.dropped;
    const Step step =
        reject(*oldest, MessageKind::kWindowDropped,
               "dropped, the predictor is " + std::to_string(waiting) + " windows behind");
    if (step != Step::kOk) return false;
  }
  return false;
}

Step MapBuilder::end_turn() {
  const auto start = std::chrono::steady_clock::now();
  const BackAnswer& answer = lane_->wait();
  const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
  report_.waited_ms += spent.count();
  const Step step = take_turn(answer);
  lane_->done();
  return step;
}

Step MapBuilder::take_turn(const BackAnswer& answer) {
  if (!answer.failure.empty()) return back_failed(answer.failure);
  Step step = Step::kOk;
  unisim_request oldest;
  if (asked_.count > 0) {
    parts_.times->multi_view.add_ms(answer.window_ms);
    if (newest_ - asked_at_ > report_.lag) ++report_.late;
    if (!next_request(UNISIM_REQUEST_WINDOW, &oldest) || !same_window(oldest, asked_)) {
      ++report_.dropped;
      parts_.messages->say(
          MessageKind::kWindowDropped,
          request_name(asked_) + ": came too late, the map has gone on without it");
    } else {
      bool pending = false;
      step =
          take_answer(asked_, answer.window_status, answer.window, answer.window_reason, &pending);
      if (step == Step::kOk && !pending) step = optimize(1);
    }
  }
  for (size_t k = 0; k < answer.revision_count; ++k) take_revision(answer.revisions[k].revision);
  if (step == Step::kOk && answer.revision_count > 0) step = optimize(1);
  bool wide_taken = false;
  if (step == Step::kOk && answer.wide_status == UNISIM_PREDICTION_OK) {
    step = take_wide_window(answer.wide, &wide_taken);
  }
  if (step == Step::kOk && wide_taken) step = optimize(1);
  if (answer.loop_ms > 0.0) parts_.times->loop.add_ms(answer.loop_ms);
  return step == Step::kOk ? take_loop() : step;
}

Step MapBuilder::leave_lane(bool goes_on) {
  if (lane_ == nullptr) return Step::kOk;
  const Step step = goes_on && lane_->busy() ? end_turn() : Step::kOk;
  lane_.reset();
  return step;
}

}  // namespace unisim::pipeline
