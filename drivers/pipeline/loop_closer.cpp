// SPDX-License-Identifier: MIT
// Finds loops with a predictor that has no map of its own.
#include "drivers/pipeline/loop_closer.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>

#include "drivers/pipeline/similarity.hpp"
#include "drivers/pipeline/two_views.hpp"

namespace unisim::pipeline {
namespace {

// Views around each of two places, as in the paper.
constexpr int32_t kHalf = 8;
// Neighbours show the same: every second keyframe is looked at, one between to confirm.
constexpr int32_t kEvery = 2;
// Keyframes within which a second one has to say the same, of the same stretch of the past.
constexpr int32_t kConfirmWithin = 5;
constexpr int32_t kSameStretch = kHalf;
// A loop ties the keyframes around it; the next one begins where its views end.
constexpr int32_t kRest = kHalf;
// More only wait where a live run is behind: the older ones are kept and not looked at.
constexpr size_t kMostLooks = 2 * UNISIM_WINDOW_LAG;

double square_length(const std::vector<int8_t>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0,
                         [](double sum, int8_t value) { return sum + double{1} * value * value; });
}

}  // namespace

LoopCloser::LoopCloser(const LoopConfig& config, unisim_predictor* predictor, int32_t window_size)
    : config_(config), predictor_(predictor), half_(std::min(kHalf, window_size / 2)) {}

bool LoopCloser::describe(int32_t id, Messages* messages) {
  unisim_place_descriptor out{};
  const int status = predictor_->place_descriptor(predictor_, id, &out);
  if (status == UNISIM_PREDICTION_FAILED) return false;
  if (status != UNISIM_PREDICTION_OK) return true;
  const bool first = dimension_ == 0;
  if (out.values == nullptr || out.dimension < 1 || (!first && out.dimension != dimension_) ||
      out.image_width < 1 || out.image_height < 1) {
    messages->say(MessageKind::kInvalid,
                  "place descriptor of keyframe " + std::to_string(id) + ": has " +
                      std::to_string(out.dimension) + " numbers" +
                      (first ? "" : " where others have " + std::to_string(dimension_)) +
                      ", or no image size; no loops are looked for there");
    // Releasing is for the thread of the search.
    waiting_.push_back({id, {}, 0, 0});
    return true;
  }
  dimension_ = out.dimension;
  waiting_.push_back(
      {id, {out.values, out.values + out.dimension}, out.image_width, out.image_height});
  return true;
}

bool LoopCloser::begin(int32_t settled, int32_t first) {
  work_.erase(work_.begin(), work_.begin() + static_cast<std::ptrdiff_t>(next_));
  next_ = 0;
  const auto open = std::find_if(waiting_.begin(), waiting_.end(),
                                 [&](const Described& one) { return one.id > settled; });
  work_.insert(work_.end(), std::make_move_iterator(waiting_.begin()),
               std::make_move_iterator(open));
  waiting_.erase(waiting_.begin(), open);
  if (work_.empty()) return false;
  if (book_ == nullptr && dimension_ > 0) {
    book_ = std::make_unique<PlaceBook>(predictor_, config_.places, dimension_);
  }
  first_ = first;
  return true;
}

void LoopCloser::search() {
  found_ = false;
  if (book_ != nullptr) book_->forget_before(first_);
  while (next_ < work_.size() && !found_ && failure_.empty()) {
    const Described& keyframe = work_[next_++];
    if (keyframe.values.empty()) {
      predictor_->release_place(predictor_, keyframe.id);
      continue;
    }
    drop_unconfirmed(keyframe.id);
    if (work_.size() - next_ < kMostLooks && due(keyframe.id)) look(keyframe);
    // After the search: it could take the place of the one it resembles.
    book_->add(keyframe.id, keyframe.values.data());
  }
}

bool LoopCloser::due(int32_t id) const {
  return id >= rest_until_ && (id % kEvery == 0 || !sights_.empty());
}

void LoopCloser::look(const Described& keyframe) {
  unisim_places_question question{};
  question.id = keyframe.id;
  question.gap = config_.gap;
  question.spread = half_;
  question.descriptor = keyframe.values.data();
  const double least = config_.likeness * square_length(keyframe.values);
  for (const unisim_places_match& match : book_->query(question, config_.tries)) {
    if (match.score < least || compare(keyframe, match) || !failure_.empty()) return;
  }
}

/// @return true: nothing else needs to be looked at
bool LoopCloser::compare(const Described& keyframe, const unisim_places_match& match) {
  unisim_place_report report{};
  report.keyframe = keyframe.id;
  report.candidate = match.id;
  report.score = match.score;
  Sight sight{};
  report.reason = inspect(keyframe, match.id, &report, &sight);
  const bool seen = report.reason == nullptr;
  if (seen) report.reason = "waits for another keyframe to say the same";
  reports_.add(report);
  if (!seen) return false;
  if (const Sight* other = companion(sight)) {
    close(Sight(*other), sight);
  } else {
    sights_.push_back(sight);
  }
  return true;
}

/// @return NULL where both show one place, else why not
const char* LoopCloser::inspect(const Described& keyframe, int32_t candidate,
                                unisim_place_report* report, Sight* sight) {
  if (!ask({candidate, keyframe.id})) return "the predictor gave no prediction of the two";
  TwoViews views{};
  views.aspect = static_cast<double>(keyframe.image_width) / keyframe.image_height;
  if (!pick_two(window_, candidate, keyframe.id, keyframe.image_width, &views)) {
    return "the predictor gave no prediction of the two";
  }
  const Overlap overlap = measure_overlap(views);
  report->matches = overlap.cells;
  report->pose_inliers = overlap.in_view;
  report->patch_inliers = overlap.agree;
  report->in_view = overlap.in_view;
  *sight = {keyframe.id, candidate, in_median_depths(views)};
  return why_apart(overlap);
}

const LoopCloser::Sight* LoopCloser::companion(const Sight& sight) const {
  const auto fits = [&](const Sight& other) {
    // Either may have made room meanwhile.
    return std::abs(sight.candidate - other.candidate) <= kSameStretch &&
           book_->holds(other.candidate) && book_->holds(other.keyframe);
  };
  const auto found = std::find_if(sights_.begin(), sights_.end(), fits);
  return found == sights_.end() ? nullptr : &*found;
}

/// Asks for the window over both places, and holds what the two sights say against it.
void LoopCloser::close(const Sight& first, const Sight& second) {
  closing_ = {first, second};
  sights_.clear();
  const std::vector<int32_t> ids = views_of(first, second);
  if (!ask(ids)) return decide("the predictor gave no window over both places", false);
  for (const Sight& sight : closing_) {
    TwoViews views{};
    if (!pick_two(window_, sight.candidate, sight.keyframe, 0, &views)) {
      return decide("the window over both places has lost one of them", false);
    }
    if (!agree(in_median_depths(views), sight.T_candidate_keyframe)) {
      return decide("the window over both places says otherwise", false);
    }
  }
  found_ = true;
  rest_until_ = second.keyframe + kRest;
}

/// Of each place the nearest kept ones, with the four that were compared.
std::vector<int32_t> LoopCloser::views_of(const Sight& first, const Sight& second) const {
  const int32_t newest = second.keyframe;
  const int32_t reach = std::min(2 * kHalf, config_.gap - 1);
  std::vector<int32_t> ids = {first.candidate, second.candidate, first.keyframe, second.keyframe};
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  const auto fill = [&](const std::vector<int32_t>& more, size_t most) {
    for (const int32_t id : more) {
      if (ids.size() < most && std::find(ids.begin(), ids.end(), id) == ids.end()) {
        ids.push_back(id);
      }
    }
  };
  const auto half = static_cast<size_t>(half_);
  const size_t newer = first.keyframe == second.keyframe ? 1 : 2;
  fill(book_->around(second.candidate, half_, reach, newest - config_.gap), half + newer);
  fill(book_->around(newest, half_, reach, newest), 2 * half);
  std::sort(ids.begin(), ids.end());
  return ids;
}

/// A prediction of keyframes into window_. @return false: there is none
bool LoopCloser::ask(const std::vector<int32_t>& ids) {
  window_ = {};
  const int status =
      predictor_->multi_view(predictor_, ids.data(), static_cast<int32_t>(ids.size()), &window_);
  if (status == UNISIM_PREDICTION_FAILED) {
    const bool own = predictor_->window_message != nullptr;
    failure_ = own ? predictor_->window_message(predictor_) : predictor_->message(predictor_);
  }
  return status == UNISIM_PREDICTION_OK;
}

void LoopCloser::settle(const char* refused) {
  found_ = false;
  if (refused == nullptr) reports_.count_loops(1);
  decide(refused == nullptr ? "loop" : refused, refused == nullptr);
}

/// The report on a sight.
std::function<bool(const unisim_place_report&)> LoopCloser::told_of(const Sight& sight) {
  return [sight](const unisim_place_report& report) {
    return report.keyframe == sight.keyframe && report.candidate == sight.candidate;
  };
}

void LoopCloser::decide(const char* reason, bool accepted) {
  for (const Sight& sight : closing_) {
    reports_.decide(told_of(sight), accepted, reason);
  }
  closing_.clear();
}

void LoopCloser::drop_unconfirmed(int32_t newest) {
  const auto over = [&](const Sight& sight) {
    if (newest - sight.keyframe <= kConfirmWithin) return false;
    reports_.decide(told_of(sight), false, "no other keyframe said the same");
    return true;
  };
  sights_.erase(std::remove_if(sights_.begin(), sights_.end(), over), sights_.end());
}

void LoopCloser::finish() { drop_unconfirmed(std::numeric_limits<int32_t>::max()); }

void LoopCloser::info(unisim_predictor_info* out) const {
  reports_.info(out);
  if (book_ != nullptr && out->state_bytes > 0) out->state_bytes += book_->bytes();
}

}  // namespace unisim::pipeline
