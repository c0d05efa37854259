// SPDX-License-Identifier: MIT
// Carries predictions from the predictor to the session.
#include "drivers/pipeline/map_builder.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/pipeline/ground_plane.hpp"

namespace unisim::pipeline {

MapBuilder::MapBuilder(const Parts& parts, size_t max_submaps)
    : parts_(parts),
      windows_(max_submaps),
      wide_windows_(parts.session),
      distances_(parts.session, parts.odometry, parts.window_size, parts.messages),
      metres_(parts.session) {
  make_loops();
  if (parts.predictor->concurrent_windows == 0) return;
  lane_ = std::make_unique<BackLane>(parts.predictor, parts.window_size, loops_.get());
  report_.beside = true;
  report_.lag = std::clamp(parts.window_step / 2, 1, UNISIM_WINDOW_LAG / 2);
}

Step MapBuilder::session_failed(const char* call, unisim_status status) {
  if (status == UNISIM_ERR_CAPACITY) return Step::kCapacity;
  parts_.messages->say(std::string(call) + ": " + unisim_status_string(status));
  return Step::kSessionFailed;
}

void MapBuilder::go_on_after(int32_t keyframes) {
  newest_ = last_settled_ = keyframes - 1;
  // The windows of the map end there.
  wide_windows_.note_gap();
}

Step MapBuilder::add_to_session(const unisim_frame& frame, int32_t* id) {
  const unisim_status status = parts_.session->add_keyframe(frame.timestamp_ns, id);
  if (status != UNISIM_OK) return session_failed("unisim_add_keyframe", status);
  newest_ = *id;
  image_width_ = frame.image.width;
  image_height_ = frame.image.height;
  distances_.note_keyframe(*id);
  return Step::kOk;
}

Step MapBuilder::add_to_predictor(const unisim_frame& frame, int32_t id) {
  {
    const ScopedLatency timer(parts_.times->keyframe);
    const int answer = parts_.predictor->keyframe(parts_.predictor, &frame, id);
    if (answer == UNISIM_PREDICTION_FAILED) return Step::kPredictorFailed;
  }
  if (loops_ == nullptr) return Step::kOk;
  const ScopedLatency timer(parts_.times->descriptor);
  return loops_->describe(id, parts_.messages) ? Step::kOk : Step::kPredictorFailed;
}

bool MapBuilder::next_request(uint32_t kind, unisim_request* request) {
  return parts_.session->next_request(kind, request) == UNISIM_OK;
}

Step MapBuilder::reject(const unisim_request& request, MessageKind kind, const std::string& why) {
  parts_.messages->say(kind, request_name(request) + ": " + why);
  const unisim_status status = parts_.session->reject(request);
  if (status != UNISIM_OK) return session_failed("unisim_reject_request", status);
  if (request.kind == UNISIM_REQUEST_PAIR) {
    last_settled_ = request.keyframe_ids[1];
    scale_guessed_ = false;
  }
  return Step::kOk;
}

Step MapBuilder::serve_pairs() {
  unisim_request request;
  bool pending = false;
  Step step = Step::kOk;
  while (step == Step::kOk && !pending && next_request(UNISIM_REQUEST_PAIR, &request)) {
    step = serve_pair(request, &pending);
  }
  if (step == Step::kOk) distances_.settle(last_settled_);
  return step;
}

Step MapBuilder::serve_pair(const unisim_request& request, bool* pending) {
  unisim_pair_prediction prediction{};
  int answer = UNISIM_PREDICTION_OK;
  {
    const ScopedLatency timer(parts_.times->two_view);
    answer = parts_.predictor->two_view(parts_.predictor, request.keyframe_ids[0],
                                        request.keyframe_ids[1], &prediction);
  }
  *pending = answer == UNISIM_PREDICTION_PENDING;
  if (*pending) return Step::kOk;
  if (answer == UNISIM_PREDICTION_FAILED) return Step::kPredictorFailed;
  if (answer != UNISIM_PREDICTION_OK) {
    return reject(request, MessageKind::kPairRejected, predictor_message());
  }
  const int32_t j = request.keyframe_ids[1];
  if (prediction.gap < 0 || prediction.gap > request.keyframe_ids[0]) {
    return reject(request, MessageKind::kInvalid,
                  "prediction has a gap that begins at no keyframe");
  }
  const unisim_status status =
      parts_.session->add_two_view(request.keyframe_ids[0] - prediction.gap, j, prediction);
  if (status == UNISIM_ERR_INVALID_ARGUMENT) {
    return reject(request, MessageKind::kInvalid, "prediction is not finite or has a wrong size");
  }
  if (status == UNISIM_ERR_RETIRED) {
    return reject(request, MessageKind::kPairRejected,
                  "was lost for too long to be tied to the map");
  }
  if (status != UNISIM_OK) return session_failed("unisim_add_two_view", status);
  if (prediction.gap > 0) wide_windows_.note_gap();
  last_settled_ = j;
  scale_guessed_ = prediction.log_scale_sigma > 0;
  return Step::kOk;
}

Step MapBuilder::serve_windows() {
  unisim_request request;
  bool pending = false;
  bool changed = false;
  Step step = Step::kOk;
  while (step == Step::kOk && !pending && next_request(UNISIM_REQUEST_WINDOW, &request)) {
    step = serve_window(request, &pending);
    changed = changed || !pending;
  }
  if (step == Step::kOk && changed) step = optimize(1);
  return step;
}

Step MapBuilder::serve_window(const unisim_request& request, bool* pending) {
  unisim_window_prediction window{};
  int answer = UNISIM_PREDICTION_OK;
  {
    const ScopedLatency timer(parts_.times->multi_view);
    answer = parts_.predictor->multi_view(parts_.predictor, request.keyframe_ids, request.count,
                                          &window);
  }
  const bool refused = answer == UNISIM_PREDICTION_REJECTED || answer == UNISIM_PREDICTION_FAILED;
  const std::string reason = refused ? window_message() : "";
  return take_answer(request, answer, window, reason, pending);
}

std::string MapBuilder::window_message() const {
  const bool own = parts_.predictor->window_message != nullptr;
  return own ? parts_.predictor->window_message(parts_.predictor) : predictor_message();
}

Step MapBuilder::back_failed(const std::string& why) {
  failure_ = why;
  return Step::kPredictorFailed;
}

Step MapBuilder::take_answer(const unisim_request& request, int status,
                             const unisim_window_prediction& window, const std::string& reason,
                             bool* pending) {
  *pending = status == UNISIM_PREDICTION_PENDING;
  if (*pending) return Step::kOk;
  if (status == UNISIM_PREDICTION_FAILED) return back_failed(reason);
  if (status != UNISIM_PREDICTION_OK) return reject(request, MessageKind::kWindowRejected, reason);
  if (window.remark != nullptr) {
    parts_.messages->say(MessageKind::kWindowReduced, request_name(request) + ": " + window.remark);
  }
  return take_window(request, window, pending);
}

Step MapBuilder::take_window(const unisim_request& request, const unisim_window_prediction& window,
                             bool* pending) {
  int32_t submap_id = -1;
  const unisim_status status = parts_.session->add_submap(window, &submap_id);
  *pending = status == UNISIM_ERR_NOT_READY;
  if (*pending) return Step::kOk;
  if (status == UNISIM_ERR_INVALID_ARGUMENT) {
    return reject(request, MessageKind::kInvalid, "prediction is not finite or has a wrong size");
  }
  if (status != UNISIM_OK) return session_failed("unisim_add_submap", status);
  if (submap_id < 0) {
    unisim_session_info info{};
    const bool known = parts_.session->get_info(&info) == UNISIM_OK;
    parts_.messages->say(MessageKind::kWindowRejected,
                         request_name(request) + ": " +
                             refusal_text(known ? info.refused_window : unisim_refusal{}));
    return Step::kOk;
  }
  windows_.add(window, submap_id);
  take_unit(submap_id, window);
  take_height(submap_id, window);
  for (Listener* listener : *parts_.listeners) listener->on_window(submap_id, window);
  tell_retired();
  return Step::kOk;
}

/// A predictor that knows metres says how long its unit is.
void MapBuilder::take_unit(int32_t submap_id, const unisim_window_prediction& window) {
  if (!(window.metres_per_unit > 0.0)) return;
  unisim_submap_unit unit{};
  unit.submap_id = submap_id;
  unit.source = UNISIM_METRIC_MODEL;
  unit.metres = window.metres_per_unit;
  unit.sigma = window.metres_sigma;
  unit.common_sigma = window.metres_common_sigma;
  add_unit(unit);
}

void MapBuilder::add_unit(const unisim_submap_unit& unit) {
  const unisim_status status = parts_.session->add_submap_unit(unit);
  if (status == UNISIM_OK) return;
  parts_.messages->say(MessageKind::kInvalid, "metres of submap " + std::to_string(unit.submap_id) +
                                                  ": " + unisim_status_string(status));
}

/// While windows are asked for beside, a predictor cannot be asked; networks find theirs anyway.
double MapBuilder::focal_sigma() const {
  constexpr double kUnknown = 0.1;
  if (parts_.predictor->concurrent_windows != 0) return kUnknown;
  unisim_predictor_info now{};
  parts_.predictor->info(parts_.predictor, &now);
  return now.focal_px > 0.0 ? now.focal_sigma_px / now.focal_px : kUnknown;
}

/// How high a camera is over the ground says how long the unit of a window is that sees it.
void MapBuilder::take_height(int32_t submap_id, const unisim_window_prediction& window) {
  if (!(parts_.camera_height > 0.0)) return;
  const GroundPlane ground = find_ground(window, image_width_, image_height_);
  if (!(ground.height > 0.0)) {
    parts_.messages->say(
        MessageKind::kNoGround,
        "camera height: window " + std::to_string(submap_id) + ": " + ground.reason);
    return;
  }
  // How well a height is known, and how far the body nods and sinks in.
  constexpr double kCommonSigma = 0.03;
  unisim_submap_unit unit{};
  unit.submap_id = submap_id;
  unit.source = UNISIM_METRIC_HEIGHT;
  unit.metres = parts_.camera_height / ground.height;
  unit.sigma = ground.sigma;
  // A focal length that is too long makes the ground as much too low.
  unit.common_sigma = std::hypot(kCommonSigma, focal_sigma());
  add_unit(unit);
}

Step MapBuilder::serve_revisions() {
  if (parts_.predictor->next_revision == nullptr) return Step::kOk;
  bool changed = false;
  for (;;) {
    unisim_window_revision revision{};
    int answer = UNISIM_PREDICTION_OK;
    {
      const ScopedLatency timer(parts_.times->revision);
      answer = parts_.predictor->next_revision(parts_.predictor, &revision);
    }
    if (answer == UNISIM_PREDICTION_FAILED) return back_failed(window_message());
    if (answer == UNISIM_PREDICTION_PENDING) break;
    if (answer != UNISIM_PREDICTION_OK) continue;
    take_revision(revision);
    changed = true;
  }
  return changed ? optimize(1) : Step::kOk;
}

void MapBuilder::take_revision(const unisim_window_revision& revision) {
  const int32_t submap_id = windows_.submap_of(revision.token);
  if (submap_id < 0) return;
  const unisim_status status = parts_.session->update_submap(submap_id, revision);
  if (status != UNISIM_OK) {
    parts_.messages->say(MessageKind::kInvalid, "revision of submap " + std::to_string(submap_id) +
                                                    ": " + unisim_status_string(status));
    return;
  }
  for (Listener* listener : *parts_.listeners) listener->on_revision(submap_id, revision);
}

Step MapBuilder::serve_wide_windows() {
  if (!wants_wide_window()) return Step::kOk;
  bool changed = false;
  for (;;) {
    unisim_window_prediction window{};
    const int answer =
        parts_.predictor->next_wide_window(parts_.predictor, parts_.window_size, &window);
    if (answer == UNISIM_PREDICTION_FAILED) return back_failed(window_message());
    if (answer == UNISIM_PREDICTION_PENDING) break;
    if (answer != UNISIM_PREDICTION_OK) continue;
    bool taken = false;
    const Step step = take_wide_window(window, &taken);
    if (step != Step::kOk) return step;
    changed = changed || taken;
  }
  return changed ? optimize(1) : Step::kOk;
}

bool MapBuilder::wants_wide_window() const {
  return parts_.predictor->next_wide_window != nullptr && wide_windows_.wanted();
}

Step MapBuilder::take_wide_window(const unisim_window_prediction& window, bool* taken) {
  const unisim_status status = wide_windows_.take(window, taken);
  return status == UNISIM_OK ? Step::kOk : session_failed("unisim_add_loop", status);
}

void MapBuilder::tell_retired() {
  unisim_retired retired;
  while (parts_.session->next_retired(&retired) == UNISIM_OK) {
    unisim_pose pose;
    const bool posed = retired.kind == UNISIM_RETIRED_KEYFRAME &&
                       parts_.session->get_pose(retired.keyframe_id, &pose) == UNISIM_OK;
    for (Listener* listener : *parts_.listeners) {
      listener->on_retired(retired, posed ? &pose : nullptr);
    }
  }
}

Step MapBuilder::reject_open_pairs() {
  unisim_request request;
  Step step = Step::kOk;
  while (step == Step::kOk && next_request(UNISIM_REQUEST_PAIR, &request)) {
    step = reject(request, MessageKind::kPairRejected, "still unknown at the end of the recording");
  }
  return step;
}

Step MapBuilder::close() {
  Step step = reject_open_pairs();
  if (step == Step::kOk) step = serve_windows();
  if (step == Step::kOk) step = serve_revisions();
  if (step == Step::kOk) step = serve_wide_windows();
  if (step != Step::kOk) return step;
  if (parts_.session->close_window() == UNISIM_OK) step = serve_windows();
  if (step == Step::kOk) step = serve_loops();
  constexpr int kFinalCalls = 5;
  return step == Step::kOk ? optimize(kFinalCalls) : step;
}

Step MapBuilder::optimize(int max_calls) {
  unisim_report report{};
  report.stop = UNISIM_STOP_BUDGET;
  for (int call = 0; call < max_calls && report.stop == UNISIM_STOP_BUDGET; ++call) {
    const unisim_status status = parts_.session->optimize(&report);
    if (status == UNISIM_ERR_NOT_READY) return Step::kOk;
    if (status == UNISIM_ERR_NUMERICAL) {
      parts_.messages->say(MessageKind::kSolver, "optimisation stopped at node " +
                                                     std::to_string(report.bad_node) +
                                                     ": poses stay as they were");
      return Step::kOk;
    }
    if (status != UNISIM_OK) return session_failed("unisim_optimize", status);
    metres_.refresh();
    for (Listener* listener : *parts_.listeners) listener->on_optimized(report);
  }
  return Step::kOk;
}

}  // namespace unisim::pipeline
