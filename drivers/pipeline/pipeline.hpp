// SPDX-License-Identifier: MIT
// The one place with threads: source -> predictor -> session -> poses, queues of fixed size.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/mapfile/map_file.hpp"
#include "drivers/pipeline/heap_watch.hpp"
#include "drivers/pipeline/keyframe_selector.hpp"
#include "drivers/pipeline/latency_histogram.hpp"
#include "drivers/pipeline/listener.hpp"
#include "drivers/pipeline/map_builder.hpp"
#include "drivers/pipeline/session_client.hpp"
#include "drivers/predictor.h"
#include "drivers/source.h"
#include "unisim/unisim.h"

namespace unisim::pipeline {

struct Options {
  KeyframeConfig keyframes;
  LoopConfig loops;
  OdometryOptions odometry;
  double camera_height = 0.0;  ///< of the camera over the ground, metres; 0: not known
  int32_t queue_frames = 8;    ///< frames decoded ahead
  bool every_frame = false;    ///< also pose the frames between keyframes
  bool realtime = false;       ///< keep to the recorded times, drop late frames
  bool live = false;           ///< the source is a camera: of frames that wait the newest is taken
  double patience_s = 60.0;    ///< a source that gives nothing for so long has failed; 0: never
  bool localise = false;       ///< look for each frame in the map of load(), which stays as it is
  std::optional<std::string> retired_folder;  ///< what leaves the window is kept for the map file,
                                              ///< on the disk of this folder, "": in memory
  bool decode_images = false;  ///< decode for the listeners what can be read, also where the
                               ///< predictor needs no images
};

enum class Outcome {
  kFinished,
  kStopped,   ///< the stop flag was raised
  kCapacity,  ///< max_keyframes or max_submaps reached: what came before is complete
  kSourceFailed,
  kPredictorFailed,
  kSessionFailed,  ///< the session could not be made or broke
};

/// What a run gives besides the map in the session.
struct Result {
  Outcome outcome = Outcome::kFinished;
  std::string message;  ///< one line unless kFinished
  Progress progress;
  StageTimes times;
  unisim_predictor_info predictor{};
  std::array<int64_t, UNISIM_REASON_COUNT>
      frames_by_reason{};   ///< frames with each UNISIM_REASON_*
  int64_t heap_calls = -1;  ///< inside the library after create, -1: not counted
  LaneReport lanes;
  int32_t image_width = 0;  ///< of the keyframes, pixels
  int32_t image_height = 0;
  bool source_held = false;  ///< the source has not come back from its last call: do not destroy it
  double wall_s = 0.0;
};

/// One run. Everything it holds is bounded by its options and its configuration: what a run makes
/// goes to the listeners.
///
/// Threads: the source is read on one of its own, and a predictor with concurrent_windows is asked
/// for windows on another; all else, the session and the listeners too, stays on the thread that
/// calls run(). Without `realtime` the result depends on the inputs alone, not on timing.
class Pipeline {
 public:
  /// @param source, predictor, listeners borrowed; they must outlive the pipeline
  /// @param config max_keyframes is the length at which the run ends with kCapacity
  /// @param stop   may be NULL; raised from anywhere, it ends the run after the current frame
  Pipeline(const Options& options, unisim_source* source, unisim_predictor* predictor,
           const unisim_config& config, std::vector<Listener*> listeners,
           const std::atomic<bool>* stop = nullptr, const HeapWatch& heap_watch = {});
  ~Pipeline();
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  /// Makes the session, so that a configuration it refuses is known before any frame is read.
  Preparation prepare();

  /// Goes on with a saved map, which is forgotten then; once, before run(). Calls prepare() if that
  /// has not been done; its answer is returned. Throws mapfile::Error.
  Preparation load(mapfile::MapFile* map);

  /// What the session had before the run: of a map that was loaded, else nothing.
  const unisim_session_info& before() const;

  /// Runs the source to its end; once. Calls prepare() if that has not been done.
  const Result& run();

  /// As it stands: for listeners while run() goes on. decode times come at its end.
  const Result& result() const;

  /// What has left the window, as a map file keeps it; with Options::retired_folder.
  mapfile::Bytes retired() const;
  /// The windows that the predictor may measure again, as a map file keeps them.
  mapfile::Bytes windows() const;

  /// How long the unit of a segment is, as the last optimisation left it: for listeners.
  Metre metre(int32_t segment) const;

  /// The map, from prepare() until destruction; NULL when prepare() failed.
  unisim_session* session() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace unisim::pipeline
