// SPDX-License-Identifier: MIT
// The one place with threads: source -> predictor -> session -> poses.
#include "drivers/pipeline/pipeline.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "drivers/pipeline/check_tables.hpp"
#include "drivers/pipeline/focal_doubt.hpp"
#include "drivers/pipeline/frame_reader.hpp"
#include "drivers/pipeline/live_poses.hpp"
#include "drivers/pipeline/localiser.hpp"
#include "drivers/pipeline/map_builder.hpp"
#include "drivers/pipeline/messages.hpp"
#include "drivers/pipeline/pacer.hpp"
#include "drivers/pipeline/retired_log.hpp"
#include "drivers/pipeline/start_watch.hpp"
#include "drivers/pipeline/tracking_reason.hpp"

namespace unisim::pipeline {

class Pipeline::Impl {
 public:
  Impl(const Options& options, unisim_source* source, unisim_predictor* predictor,
       const unisim_config& config, std::vector<Listener*> listeners, const std::atomic<bool>* stop,
       const HeapWatch& heap_watch)
      : options_(options),
        source_(source),
        predictor_(predictor),
        config_(config),
        listeners_(std::move(listeners)),
        stop_(stop),
        heap_watch_(heap_watch),
        session_(&result_.times, &heap_watch_),
        messages_(listeners_),
        selector_(options.keyframes) {
    if (!options.retired_folder) return;
    retired_.emplace(*options.retired_folder);
    listeners_.push_back(&*retired_);
  }

  Preparation prepare();
  Preparation load(mapfile::MapFile* map);
  const unisim_session_info& before() const { return before_; }
  const Result& run();
  const Result& result() const { return result_; }
  unisim_session* session() const { return session_.handle(); }
  mapfile::Bytes retired() const { return retired_ ? retired_->bytes() : mapfile::Bytes(); }
  mapfile::Bytes windows() const { return builder_->windows().bytes(); }
  Metre metre(int32_t segment) { return builder_->metres().of(segment); }

 private:
  void read_all();
  bool take(const FrameReader::Item& item);
  bool track(const FrameReader::Item& item);
  bool locate(const FrameReader::Item& item);
  void pass_over(const FrameReader::Item& item);
  bool take_keyframe(const unisim_frame& frame);
  void finish();
  bool went_well(Step step);
  void end(Outcome outcome, const std::string& message);
  void tell_progress();
  void tell_no_start();
  void tell_focal_doubt();

  Options options_;
  unisim_source* source_;
  unisim_predictor* predictor_;
  unisim_config config_;
  std::vector<Listener*> listeners_;
  const std::atomic<bool>* stop_;
  HeapWatch heap_watch_;
  Result result_;
  SessionClient session_;
  std::unique_ptr<MapBuilder> builder_;
  std::unique_ptr<LivePoses> poses_;
  Messages messages_;
  KeyframeSelector selector_;
  Pacer pacer_;
  TrackingReason reason_;
  std::optional<RetiredLog> retired_;
  unisim_session_info before_{};
  std::optional<Localiser> localiser_;  // with Options::localise
  StartWatch start_;
  FocalWatch focal_;
};

Preparation Pipeline::Impl::prepare() {
  Preparation preparation = check_tables(*source_, *predictor_);
  if (preparation.answer != Preparation::Answer::kReady) return preparation;
  preparation = session_.create(config_);
  if (preparation.answer != Preparation::Answer::kReady) return preparation;
  // Windows start w - overlap keyframes apart; one shorter window may follow.
  const int32_t step = config_.window_size - config_.window_overlap;
  const int32_t windows = config_.max_keyframes / step + 2;
  const MapBuilder::Parts parts = {&session_,
                                   predictor_,
                                   &result_.times,
                                   &messages_,
                                   &listeners_,
                                   config_.window_size,
                                   step,
                                   options_.realtime || options_.live,
                                   options_.loops,
                                   options_.odometry,
                                   options_.camera_height};
  builder_ = std::make_unique<MapBuilder>(parts, static_cast<size_t>(windows));
  poses_ = std::make_unique<LivePoses>(LivePoses::Parts{
      &session_, predictor_, builder_.get(), &listeners_, &result_.progress, parts.realtime});
  return preparation;
}

Preparation Pipeline::Impl::load(mapfile::MapFile* map) {
  if (session_.handle() == nullptr) {
    Preparation preparation = prepare();
    if (preparation.answer != Preparation::Answer::kReady) return preparation;
  }
  const mapfile::Bytes left = map->left();
  const mapfile::Bytes windows = map->windows();
  map->hand_over(session_.handle(), predictor_);
  if (session_.get_info(&before_) != UNISIM_OK) before_ = {};
  RetiredLog::tell(left, *map, session_.handle(), before_.keyframes, listeners_);
  builder_->go_on_after(before_.keyframes);
  if (!options_.localise)
    builder_->windows().load(windows, map->path(), before_.keyframes, predictor_);
  poses_->begin_at(before_.keyframes);
  if (options_.localise) localiser_.emplace(session_.handle(), predictor_);
  return {};
}

const Result& Pipeline::Impl::run() {
  if (session_.handle() == nullptr) {
    const Preparation preparation = prepare();
    if (preparation.answer != Preparation::Answer::kReady) {
      end(Outcome::kSessionFailed, preparation.message);
      return result_;
    }
  }
  const auto start = std::chrono::steady_clock::now();
  const int64_t heap_calls = heap_watch_.calls();
  result_.progress.frames_total = source_->frame_count(source_);
  read_all();
  finish();
  result_.lanes = builder_->lane_report();
  result_.frames_by_reason = reason_.frames();
  messages_.tell_counts();
  builder_->info(&result_.predictor);
  if (heap_watch_.count != nullptr) result_.heap_calls = heap_watch_.calls() - heap_calls;
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  result_.wall_s = wall.count();
  return result_;
}

void Pipeline::Impl::read_all() {
  int decode = options_.decode_images ? UNISIM_DECODE_IF_READABLE : 0;
  if (predictor_->needs_images != 0) decode = 1;
  const auto queue = options_.live ? FrameReader::Queue::kNewest : FrameReader::Queue::kWaits;
  FrameReader reader(source_, options_.live ? 1 : std::max(options_.queue_frames, 1), decode,
                     queue);
  const std::chrono::milliseconds patience(static_cast<int64_t>(1000.0 * options_.patience_s));
  for (;;) {
    if (stop_ != nullptr && stop_->load()) {
      end(Outcome::kStopped, "interrupted");
      break;
    }
    const FrameReader::Item* item = reader.next(stop_, patience);
    result_.progress.frames_waiting = reader.waiting();
    if (item != nullptr && !take(*item)) break;
  }
  reader.stop();
  result_.progress.frames_waiting = 0;
  result_.source_held = reader.holds_source();
  result_.times.decode = reader.decode_times();
}

bool Pipeline::Impl::take(const FrameReader::Item& item) {
  result_.progress.frames_dropped += item.made_way;
  if (item.status == UNISIM_FRAME_END) return false;
  if (item.status == UNISIM_FRAME_FAILED) {
    end(Outcome::kSourceFailed, item.message);
    return false;
  }
  if (item.status == UNISIM_FRAME_BAD) {
    ++result_.progress.frames_bad;
    messages_.say(MessageKind::kBadFrame, item.message);
    return true;
  }
  if (options_.realtime && !pacer_.keep(item.frame.timestamp_ns, stop_)) {
    ++result_.progress.frames_dropped;
    return true;
  }
  result_.progress.newest_ns = item.frame.timestamp_ns;
  const bool goes_on = localiser_ ? locate(item) : track(item);
  for (Listener* listener : listeners_) listener->on_frame(item.frame);
  tell_progress();
  return goes_on;
}

/// A frame of no use to the predictor, and why. Where its pixels are missing, it is that.
void Pipeline::Impl::pass_over(const FrameReader::Item& item) {
  if (item.message.empty()) {
    messages_.say(MessageKind::kUselessFrame, "frame " + std::to_string(item.frame.index) + ": " +
                                                  predictor_->message(predictor_));
    return;
  }
  --result_.progress.frames;
  ++result_.progress.frames_bad;
  messages_.say(MessageKind::kBadFrame, item.message + ": skipped");
}

bool Pipeline::Impl::track(const FrameReader::Item& item) {
  const unisim_frame& frame = item.frame;
  ++result_.progress.frames;
  const auto start = std::chrono::steady_clock::now();
  unisim_motion motion = {-1.0, -1.0, 0, 0};
  int answer = UNISIM_PREDICTION_OK;
  {
    const ScopedLatency timer(result_.times.observe);
    answer = predictor_->observe(predictor_, &frame, &motion);
  }
  if (answer == UNISIM_PREDICTION_FAILED) return went_well(Step::kPredictorFailed);
  if (answer != UNISIM_PREDICTION_OK) {
    pass_over(item);
    return true;
  }
  reason_.see_frame(motion.reason);
  tell_no_start();
  // Frames given up for want of time do not count: a replay of those that were tracked chooses the
  // same keyframes.
  const bool own_pace = options_.live || options_.realtime;
  const int64_t number = own_pace ? result_.progress.frames - 1 : frame.index;
  if (!selector_.choose(number, motion)) {
    if (options_.every_frame) poses_->give_between(frame);
    return true;
  }
  if (!item.message.empty()) messages_.say(MessageKind::kWithoutPixels, item.message);
  if (!take_keyframe(frame)) return false;
  const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
  result_.times.track_total.add_ms(spent.count());
  const bool goes_on = went_well(builder_->serve_back());
  builder_->tell_retired();
  return goes_on;
}

bool Pipeline::Impl::locate(const FrameReader::Item& item) {
  const unisim_frame& frame = item.frame;
  const bool chosen =
      options_.keyframes.stride == 0 || selector_.choose(frame.index, {-1, -1, 0, 0});
  if (!chosen) return true;
  ++result_.progress.frames;
  unisim_location found{};
  LocatedFrame located{frame.index, frame.timestamp_ns, UNISIM_STATE_LOST, {}, 0.0, -1, 0};
  int32_t segment = -1;
  int answer = UNISIM_PREDICTION_OK;
  {
    const ScopedLatency timer(result_.times.track_total);
    answer = predictor_->locate(predictor_, &frame, &found);
    if (answer == UNISIM_PREDICTION_OK && localiser_->pose(found, &located.T_world_cam, &segment)) {
      located.state = found.followed != 0 ? UNISIM_STATE_TRACKING : UNISIM_STATE_RELOCALISED;
      located.confidence = static_cast<double>(found.inliers) / std::max(found.in_view, 1);
      located.keyframe_id = found.keyframe_id;
      located.inliers = found.inliers;
    }
  }
  if (answer == UNISIM_PREDICTION_FAILED) return went_well(Step::kPredictorFailed);
  if (answer != UNISIM_PREDICTION_OK) pass_over(item);
  result_.progress.state = located.state;
  const bool known = located.state != UNISIM_STATE_LOST;
  if (known) {
    ++result_.progress.frames_located;
    located.metre = result_.progress.metre = metre(segment);
  }
  for (Listener* listener : listeners_) listener->on_located(located);
  if (known) poses_->give_located(located, segment);
  return true;
}

bool Pipeline::Impl::take_keyframe(const unisim_frame& frame) {
  int32_t id = -1;
  if (!went_well(builder_->add_to_session(frame, &id))) return false;
  if (options_.every_frame) poses_->give_early(frame, id);
  if (!went_well(builder_->add_to_predictor(frame, id))) return false;
  ++result_.progress.keyframes;
  result_.image_width = frame.image.width;
  result_.image_height = frame.image.height;
  for (Listener* listener : listeners_) listener->on_keyframe(id, frame);
  const bool goes_on = went_well(builder_->serve_pairs());
  poses_->give_keyframes(false);
  const bool may_ask = predictor_->concurrent_windows == 0;  // see tell_no_start()
  if (may_ask && focal_.due(result_.progress.keyframes)) tell_focal_doubt();
  return goes_on;
}

/// While windows are asked for beside, a predictor cannot be asked how it stands.
void Pipeline::Impl::tell_no_start() {
  if (predictor_->concurrent_windows != 0 || poses_->any()) return;
  if (!start_.due(result_.progress.frames)) return;
  unisim_predictor_info info{};
  predictor_->info(predictor_, &info);
  if (info.no_start != nullptr) messages_.say(info.no_start);
}

void Pipeline::Impl::tell_focal_doubt() {
  unisim_predictor_info info{};
  predictor_->info(predictor_, &info);
  const std::string doubt = focal_doubt(info);
  if (!doubt.empty()) messages_.say(doubt);
}

void Pipeline::Impl::finish() {
  const bool usable =
      result_.outcome != Outcome::kPredictorFailed && result_.outcome != Outcome::kSessionFailed;
  const bool lane_left = went_well(builder_->leave_lane(usable));
  if (!usable || !lane_left || result_.progress.keyframes == 0) return;
  if (predictor_->finish != nullptr && predictor_->finish(predictor_) == UNISIM_PREDICTION_FAILED) {
    went_well(Step::kPredictorFailed);
    return;
  }
  // A predictor that never started leaves no map to close.
  if (went_well(builder_->serve_pairs()) && builder_->last_settled() > 0) {
    went_well(builder_->close());
    builder_->tell_retired();
  }
  poses_->give_keyframes(true);
  tell_progress();
  tell_focal_doubt();
}

bool Pipeline::Impl::went_well(Step step) {
  if (step == Step::kOk) return true;
  if (step == Step::kPredictorFailed) {
    end(Outcome::kPredictorFailed,
        std::string(predictor_->name) + " predictor: " + builder_->failure());
  } else if (step == Step::kCapacity) {
    end(Outcome::kCapacity, "the map is full at " + std::to_string(result_.progress.keyframes) +
                                " keyframes; raise session.max_keyframes");
  } else {
    end(Outcome::kSessionFailed, "session: broken; please report this");
  }
  return false;
}

void Pipeline::Impl::end(Outcome outcome, const std::string& message) {
  // The first reason to end stands; what follows while closing is its consequence.
  if (result_.outcome != Outcome::kFinished) return;
  result_.outcome = outcome;
  result_.message = message;
}

void Pipeline::Impl::tell_progress() {
  unisim_session_info info{};
  if (session_.get_info(&info) == UNISIM_OK) {
    // Nothing changes in the session while frames are only looked for in its map.
    if (!localiser_) result_.progress.state = info.state;
    result_.progress.submaps = info.submaps;
    result_.progress.loops = info.loops;
    result_.progress.reason = reason_.of_state(result_.progress.state, builder_->scale_guessed());
  }
  for (Listener* listener : listeners_) listener->on_progress(result_.progress);
}

Pipeline::Pipeline(const Options& options, unisim_source* source, unisim_predictor* predictor,
                   const unisim_config& config, std::vector<Listener*> listeners,
                   const std::atomic<bool>* stop, const HeapWatch& heap_watch)
    : impl_(std::make_unique<Impl>(options, source, predictor, config, std::move(listeners), stop,
                                   heap_watch)) {}

Pipeline::~Pipeline() = default;

Preparation Pipeline::prepare() { return impl_->prepare(); }

Preparation Pipeline::load(mapfile::MapFile* map) { return impl_->load(map); }

const unisim_session_info& Pipeline::before() const { return impl_->before(); }

const Result& Pipeline::run() { return impl_->run(); }

const Result& Pipeline::result() const { return impl_->result(); }

mapfile::Bytes Pipeline::retired() const { return impl_->retired(); }

mapfile::Bytes Pipeline::windows() const { return impl_->windows(); }

Metre Pipeline::metre(int32_t segment) const { return impl_->metre(segment); }

unisim_session* Pipeline::session() const { return impl_->session(); }

}  // namespace unisim::pipeline
