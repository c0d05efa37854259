// SPDX-License-Identifier: MIT
// The C face of the pipeline: a run on a thread of its own.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "drivers/common/copy_out.hpp"
#include "drivers/common/has_places.hpp"
#include "drivers/common/owned.hpp"
#include "drivers/geometric/geometric.h"
#include "drivers/lcm/session_publisher.hpp"
#include "drivers/library/pipeline.h"
#include "drivers/pipeline/map_saving.hpp"
#include "drivers/pipeline/pipeline.hpp"
#include "drivers/pipeline/session_defaults.hpp"
#include "drivers/pipeline/similarity.hpp"
#include "drivers/pipeline/tracking_reason.hpp"

namespace {

using unisim::drivers::copy_out;
using unisim::drivers::PredictorPtr;
using unisim::drivers::SourcePtr;
using unisim::pipeline::Listener;
using unisim::pipeline::LivePose;
using unisim::pipeline::Outcome;
using unisim::pipeline::Pipeline;
using unisim::pipeline::Preparation;
using unisim::pipeline::Progress;

void write_line(const std::string& line, char* message, size_t capacity) {
  if (message != nullptr && capacity > 0) std::snprintf(message, capacity, "%s", line.c_str());
}

/// What the caller knows of the struct, the rest as by default. false: it is of no release, or sets
/// what this one does not know.
bool read_config(const unisim_pipeline_config* given, unisim_pipeline_config* config) {
  constexpr size_t kFirstRelease = offsetof(unisim_pipeline_config, lcm);
  if (given == nullptr || given->struct_size < kFirstRelease) return false;
  const auto* bytes = reinterpret_cast<const unsigned char*>(given);
  for (size_t i = sizeof *config; i < given->struct_size; ++i) {
    if (bytes[i] != 0) return false;
  }
  unisim_pipeline_config_init(config, sizeof *config);
  std::memcpy(config, given, std::min<size_t>(given->struct_size, sizeof *config));
  config->struct_size = sizeof *config;
  return true;
}

}  // namespace

/// The run, and what listens to it for the callbacks.
struct unisim_pipeline : Listener {
  explicit unisim_pipeline(const unisim_pipeline_config& given) : config(given) {}

  Preparation prepare();
  Preparation load_map();
  void save_map() const;
  void listen_for_lcm(std::vector<Listener*>* listeners);
  void start();
  int wait(std::chrono::milliseconds time);
  int end();

  void on_live_pose(const LivePose& pose) override;
  void on_keyframe_pose(const unisim_pose& keyframe) override;
  void on_optimized(const unisim_report& report) override;
  void on_progress(const Progress& progress) override;
  void on_message(const std::string& line) override;

  bool read_pose(int32_t keyframe, unisim_pose* pose) const;
  void finish(int how, const std::string& why);

  unisim_pipeline_config config;
  SourcePtr source;
  PredictorPtr predictor;
  std::unique_ptr<unisim::lcm::SessionPublisher> publisher;  // NULL: not told over LCM
  std::unique_ptr<Pipeline> run;
  std::optional<std::string> map_to_save;
  unisim::pipeline::DistanceInbox inbox;
  std::atomic<bool> stop{false};
  std::thread thread;

  // of the pipeline's thread
  int32_t state = UNISIM_STATE_INIT;
  unisim_pose newest{};  // keyframe as those who listen have it; struct_size 0: none
  int32_t revision = 0;

  mutable std::mutex mutex;
  std::condition_variable ended;
  int how_it_stands = UNISIM_PIPELINE_RUNS;
  std::string why;
  unisim_pipeline_status status{};
  unisim_live_pose live{};  // struct_size 0: none yet
};

Preparation unisim_pipeline::prepare() {
  using Answer = Preparation::Answer;
  if (predictor == nullptr) {
    char line[256] = "";
    predictor.reset(unisim_geometric_create(nullptr, line, sizeof line));
    if (predictor == nullptr) return {Answer::kBadConfiguration, line};
  }
  unisim_config session{};
  if (config.session != nullptr) {
    session = *config.session;
  } else {
    if (unisim_config_init(&session, sizeof session) != UNISIM_OK) {
      return {Answer::kFailed, "libunisim and libunisim_drivers do not fit together"};
    }
    session.window_submaps = unisim::pipeline::kSlidingSubmaps;
    session.window_overlap = unisim::pipeline::usual_overlap(predictor->name, session.window_size);
  }
  unisim::pipeline::Options options;
  options.live = config.live != 0;
  options.realtime = config.realtime != 0;
  options.every_frame = config.every_frame != 0;
  options.keyframes.stride = config.stride;
  options.patience_s = config.patience_ms / 1000.0;
  options.localise = config.localise != 0;
  options.odometry = {nullptr, 0.0, 0.0, &inbox};
  options.camera_height = config.camera_height;
  if (!(config.camera_height >= 0.0 && std::isfinite(config.camera_height))) {
    return {Answer::kBadConfiguration, "pipeline: camera_height is no height; give metres, or 0"};
  }
  if (options.localise && (config.load_map == nullptr || config.save_map != nullptr)) {
    return {Answer::kBadConfiguration,
            "pipeline: localise needs load_map, and leaves nothing for save_map"};
  }
  if (config.save_map != nullptr) {
    map_to_save = config.save_map;
    options.retired_folder = std::filesystem::path(*map_to_save).parent_path().string();
  }
  if (config.session == nullptr) {
    const bool places = unisim::drivers::has_places(*predictor);
    session.max_keyframes = unisim::pipeline::keyframe_capacity(
        session, -1, options.keyframes, session.max_keyframes, places ? options.loops.places : 0);
  }
  if (config.lcm_points < 0) {
    return {Answer::kBadConfiguration,
            "pipeline: lcm_points is " + std::to_string(config.lcm_points) + ", give 0 or more"};
  }
  std::vector<Listener*> listeners{this};
  listen_for_lcm(&listeners);
  run =
      std::make_unique<Pipeline>(options, source.get(), predictor.get(), session, listeners, &stop);
  if (publisher != nullptr) publisher->attach(run.get());
  const Preparation ready = run->prepare();
  return ready.answer == Answer::kReady ? load_map() : ready;
}

void unisim_pipeline::save_map() const {
  unisim::mapfile::About about;
  about.program = "libunisim_drivers";
  unisim::pipeline::save_map(*map_to_save, about, *run, predictor.get());
}

Preparation unisim_pipeline::load_map() {
  if (map_to_save) unisim::mapfile::check_writable(*map_to_save);
  if (config.load_map == nullptr) return {};
  unisim::mapfile::MapFile map(config.load_map);
  return run->load(&map);
}

void unisim_pipeline::listen_for_lcm(std::vector<Listener*>* listeners) {
  if (config.lcm == nullptr) return;
  unisim::lcm::SessionPublisherOptions how;
  how.images = config.lcm_images != 0;
  how.points_per_submap = config.lcm_points;
  if (config.lcm_folder != nullptr) how.folder = config.lcm_folder;
  publisher = std::make_unique<unisim::lcm::SessionPublisher>(config.lcm, how);
  listeners->push_back(publisher.get());
}

void unisim_pipeline::start() {
  thread = std::thread([this] {
    try {
      const auto& result = run->run();
      if (result.predictor.no_start != nullptr) on_message(result.predictor.no_start);
      if (publisher != nullptr) publisher->finish();
      if (result.source_held) static_cast<void>(source.release());  // it may still come back
      if (map_to_save) save_map();
      const bool failed =
          result.outcome != Outcome::kFinished && result.outcome != Outcome::kStopped;
      finish(failed                                ? UNISIM_PIPELINE_FAILED
             : result.outcome == Outcome::kStopped ? UNISIM_PIPELINE_STOPPED
                                                   : UNISIM_PIPELINE_FINISHED,
             failed ? result.message : "");
    } catch (const std::exception& error) {
      finish(UNISIM_PIPELINE_FAILED, error.what());
    }
  });
}

void unisim_pipeline::finish(int how, const std::string& line) {
  const std::lock_guard<std::mutex> lock(mutex);
  how_it_stands = how;
  why = line;
  ended.notify_all();
}

int unisim_pipeline::wait(std::chrono::milliseconds time) {
  std::unique_lock<std::mutex> lock(mutex);
  ended.wait_for(lock, time, [this] { return how_it_stands != UNISIM_PIPELINE_RUNS; });
  return how_it_stands;
}

int unisim_pipeline::end() {
  stop.store(true);
  if (thread.joinable()) thread.join();
  return how_it_stands;
}

bool unisim_pipeline::read_pose(int32_t keyframe, unisim_pose* pose) const {
  *pose = {};
  pose->struct_size = sizeof *pose;
  return unisim_get_pose(run->session(), keyframe, pose) == UNISIM_OK;
}

void unisim_pipeline::on_live_pose(const LivePose& pose) {
  unisim_pose keyframe{};
  const bool in_map = pose.keyframe_id >= 0 && read_pose(pose.keyframe_id, &keyframe);
  if (in_map && keyframe.confidence > 0) state = keyframe.state;
  unisim_live_pose told{};
  told.struct_size = sizeof told;
  told.keyframe_id = pose.keyframe_id;
  told.timestamp_ns = pose.timestamp_ns;
  told.T_world_cam = pose.T_world_cam;
  told.state = state;
  told.segment = pose.segment;
  told.reason = status.reason;
  told.metres_per_unit = pose.metre.per_unit;
  told.scale_sigma = pose.metre.sigma;
  {
    const std::lock_guard<std::mutex> lock(mutex);
    live = told;
  }
  if (config.on_pose != nullptr) config.on_pose(&told, config.user);
}

void unisim_pipeline::on_keyframe_pose(const unisim_pose& keyframe) {
  newest = keyframe;
  state = keyframe.state;
  if (config.on_keyframe != nullptr) config.on_keyframe(&keyframe, config.user);
}

/// The jump from where listeners have the newest keyframe to where it is now.
void unisim_pipeline::on_optimized(const unisim_report& report) {
  if (report.map_revision == revision) return;
  revision = report.map_revision;
  unisim_pose now{};
  if (newest.struct_size == 0 || !read_pose(newest.keyframe_id, &now)) return;
  unisim_correction correction{};
  correction.struct_size = sizeof correction;
  correction.map_revision = report.map_revision;
  correction.first_changed = report.first_changed;
  correction.last_changed = report.last_changed;
  correction.keyframe_id = now.keyframe_id;
  correction.segment = now.segment;
  correction.timestamp_ns = now.timestamp_ns;
  correction.T_new_old =
      unisim::pipeline::compose(now.T_world_kf, unisim::pipeline::inverse(newest.T_world_kf));
  const unisim::pipeline::Metre metre = run->metre(now.segment);
  correction.metres_per_unit = metre.per_unit;
  correction.scale_sigma = metre.sigma;
  newest = now;
  if (config.on_correction != nullptr) config.on_correction(&correction, config.user);
}

void unisim_pipeline::on_progress(const Progress& progress) {
  bool changed = false;
  {
    const std::lock_guard<std::mutex> lock(mutex);
    changed = status.state != progress.state;
    status.state = progress.state;
    status.frames = progress.frames;
    status.frames_bad = progress.frames_bad;
    status.frames_dropped = progress.frames_dropped;
    status.keyframes = progress.keyframes;
    status.submaps = progress.submaps;
    status.reason = progress.reason;
    status.metres_per_unit = progress.metre.per_unit;
    status.scale_sigma = progress.metre.sigma;
  }
  state = progress.state;
  if (changed && config.on_state != nullptr) config.on_state(state, config.user);
}

void unisim_pipeline::on_message(const std::string& line) {
  if (config.on_message != nullptr) config.on_message(line.c_str(), config.user);
}

void unisim_pipeline_config_init(unisim_pipeline_config* config, size_t struct_size) {
  unisim_pipeline_config defaults{};
  defaults.struct_size = sizeof defaults;
  defaults.every_frame = 1;
  defaults.patience_ms = 60000;
  config->struct_size = static_cast<uint32_t>(struct_size);
  copy_out(defaults, config);
}

unisim_pipeline* unisim_pipeline_start(const unisim_pipeline_config* config, char* message,
                                       size_t capacity) {
  unisim_pipeline_config known{};
  if (!read_config(config, &known)) {
    write_line(
        "pipeline: struct_size is not one this library knows; call "
        "unisim_pipeline_config_init()",
        message, capacity);
    return nullptr;
  }
  try {
    auto pipeline = std::make_unique<unisim_pipeline>(known);
    pipeline->source.reset(known.source);
    pipeline->predictor.reset(known.predictor);
    if (known.source == nullptr) {
      write_line("pipeline: no source; open one with unisim_v4l2_open() or unisim_sequence_open()",
                 message, capacity);
      return nullptr;
    }
    const Preparation preparation = pipeline->prepare();
    if (preparation.answer != Preparation::Answer::kReady) {
      write_line(preparation.message, message, capacity);
      return nullptr;
    }
    pipeline->start();
    return pipeline.release();
  } catch (const std::exception& error) {
    write_line(std::string("pipeline: ") + error.what(), message, capacity);
    return nullptr;
  }
}

int unisim_pipeline_poll(unisim_pipeline* pipeline, int32_t timeout_ms) {
  return pipeline->wait(std::chrono::milliseconds(std::max(timeout_ms, 0)));
}

const char* unisim_pipeline_message(const unisim_pipeline* pipeline) {
  const std::lock_guard<std::mutex> lock(pipeline->mutex);
  return pipeline->why.c_str();
}

void unisim_pipeline_get_status(const unisim_pipeline* pipeline, unisim_pipeline_status* status) {
  const std::lock_guard<std::mutex> lock(pipeline->mutex);
  copy_out(pipeline->status, status);
}

int unisim_pipeline_add_odometry(unisim_pipeline* pipeline, const unisim_odometry_step* step) {
  if (pipeline == nullptr || step == nullptr || step->struct_size < sizeof *step) return 0;
  const auto share = [](double value) { return value >= 0.0 && value <= 1.0; };
  const bool sane = step->to_ns > step->from_ns && step->metres >= 0.0 &&
                    std::isfinite(step->metres) && share(step->sigma) && share(step->common_sigma);
  if (!sane) return 0;
  constexpr double kUsualSigma = 0.02;
  const double common =
      step->common_sigma > 0.0 ? step->common_sigma : unisim::pipeline::kPathCommonSigma;
  const double sigma = step->sigma > 0.0 ? step->sigma : kUsualSigma;
  const bool taken = pipeline->inbox.add(
      unisim::pipeline::OdometryStep{step->from_ns, step->to_ns, step->metres, sigma}, common);
  return taken ? 1 : 0;
}

int unisim_pipeline_add_distance(unisim_pipeline* pipeline, const unisim_distance* distance) {
  if (pipeline == nullptr || distance == nullptr || distance->struct_size < sizeof *distance) {
    return 0;
  }
  return pipeline->inbox.add(*distance) ? 1 : 0;
}

const char* unisim_reason_name(int32_t reason) { return unisim::pipeline::reason_name(reason); }

int unisim_pipeline_get_pose(const unisim_pipeline* pipeline, unisim_live_pose* pose) {
  const std::lock_guard<std::mutex> lock(pipeline->mutex);
  if (pipeline->live.struct_size == 0) return 0;
  copy_out(pipeline->live, pose);
  return 1;
}

void unisim_pipeline_ask_stop(unisim_pipeline* pipeline) { pipeline->stop.store(true); }

int unisim_pipeline_stop(unisim_pipeline* pipeline) {
  if (pipeline == nullptr) return UNISIM_PIPELINE_FINISHED;
  const int how = pipeline->end();
  delete pipeline;
  return how;
}
