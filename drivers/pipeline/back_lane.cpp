// SPDX-License-Identifier: MIT
// Asks a predictor for windows on a thread of its own.
#include "drivers/pipeline/back_lane.hpp"

#include <chrono>
#include <exception>

namespace unisim::pipeline {
namespace {

// More wait for the next turn: the copies are bounded.
constexpr size_t kMostRevisions = 64;

}  // namespace

BackLane::BackLane(unisim_predictor* predictor, int32_t max_views, LoopCloser* loops)
    : predictor_(predictor), max_views_(max_views), loops_(loops), thread_([this] { loop(); }) {}

BackLane::~BackLane() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void BackLane::ask(const unisim_request* window, bool wide, bool loops) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    wants_window_ = window != nullptr;
    if (wants_window_) request_ = *window;
    wants_wide_ = wide;
    wants_loops_ = loops;
    asked_ = true;
  }
  busy_ = true;
  changed_.notify_all();
}

bool BackLane::answered() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return !asked_;
}

const BackAnswer& BackLane::wait() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return !asked_; });
  return answer_;
}

void BackLane::loop() {
  std::unique_lock<std::mutex> lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return asked_ || stopping_; });
    if (stopping_) return;
    lock.unlock();
    turn();
    lock.lock();
    asked_ = false;
    changed_.notify_all();
  }
}

/// No exception leaves the thread: it would end the program.
void BackLane::turn() {
  answer_.window_status = answer_.wide_status = UNISIM_PREDICTION_PENDING;
  answer_.revision_count = 0;
  answer_.failure.clear();
  answer_.loop_ms = 0.0;
  try {
    if (wants_window_) predict_window();
    if (answer_.failure.empty()) copy_revisions();
    if (answer_.failure.empty()) take_wide_window();
    if (answer_.failure.empty() && wants_loops_) search_loops();
  } catch (const std::exception& error) {
    answer_.failure = error.what();
  }
}

void BackLane::predict_window() {
  const auto start = std::chrono::steady_clock::now();
  answer_.window = {};
  answer_.window_status =
      predictor_->multi_view(predictor_, request_.keyframe_ids, request_.count, &answer_.window);
  const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
  answer_.window_ms = spent.count();
  if (answer_.window_status == UNISIM_PREDICTION_FAILED) {
    answer_.failure = predictor_->window_message(predictor_);
  } else if (answer_.window_status == UNISIM_PREDICTION_REJECTED) {
    answer_.window_reason = predictor_->window_message(predictor_);
  }
}

void BackLane::copy_revisions() {
  if (predictor_->next_revision == nullptr) return;
  while (answer_.revision_count < kMostRevisions) {
    unisim_window_revision given{};
    const int status = predictor_->next_revision(predictor_, &given);
    if (status == UNISIM_PREDICTION_PENDING) return;
    if (status == UNISIM_PREDICTION_FAILED) {
      answer_.failure = predictor_->window_message(predictor_);
      return;
    }
    if (status != UNISIM_PREDICTION_OK) continue;
    if (answer_.revisions.size() == answer_.revision_count) answer_.revisions.emplace_back();
    BackAnswer::Revision& kept = answer_.revisions[answer_.revision_count++];
    kept.poses.assign(given.T_window_kf, given.T_window_kf + given.count);
    kept.log_depth_ratio.assign(given.log_depth_ratio, given.log_depth_ratio + given.count);
    kept.revision = given;
    kept.revision.T_window_kf = kept.poses.data();
    kept.revision.log_depth_ratio = kept.log_depth_ratio.data();
  }
}

void BackLane::take_wide_window() {
  if (!wants_wide_) return;
  answer_.wide = {};
  answer_.wide_status = predictor_->next_wide_window(predictor_, max_views_, &answer_.wide);
  if (answer_.wide_status == UNISIM_PREDICTION_FAILED) {
    answer_.failure = predictor_->window_message(predictor_);
  }
}

void BackLane::search_loops() {
  const auto start = std::chrono::steady_clock::now();
  loops_->search();
  const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
  answer_.loop_ms = spent.count();
  answer_.failure = loops_->failure();
}

}  // namespace unisim::pipeline
