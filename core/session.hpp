// SPDX-License-Identifier: MIT
// The session: wires keyframes, submaps, depth, graph and solver; the one class that capi sees.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/base/arena.hpp"
#include "core/base/counter.hpp"
#include "core/base/invariants.hpp"
#include "core/base/status.hpp"
#include "core/graph/graph.hpp"
#include "core/map/depth_book.hpp"
#include "core/map/distance_book.hpp"
#include "core/map/gauge.hpp"
#include "core/map/keyframe_ring.hpp"
#include "core/map/map.hpp"
#include "core/map/request_schedule.hpp"
#include "core/map/submap_table.hpp"
#include "core/map/tie_edges.hpp"
#include "core/map/tracking_state.hpp"
#include "core/session/refusals.hpp"
#include "core/session_config.hpp"
#include "core/skeleton/loop_watch.hpp"
#include "core/skeleton/skeleton.hpp"
#include "core/snapshot/archive.hpp"
#include "core/solve/lm.hpp"

namespace unisim {

/// Checked two-view prediction.
struct TwoViewInput {
  int32_t i = 0;
  int32_t j = 0;
  Sim3 T_i_j;  ///< scale 1
  DepthMap depth_i;
  DepthMap depth_j;
  double center_sigma = 0.0;     ///< >= 0, 0: not known
  double log_scale_sigma = 0.0;  ///< >= 0: of the scale carried over from i
};

/// Checked multi-view prediction; the arrays are the caller's.
struct SubmapInput {
  Span<const int32_t> keyframes;  ///< ascending
  Span<const Sim3> T_submap_kf;   ///< scale 1, any gauge
  Span<const DepthMap> depth;
  double center_sigma = 0.0;
};

/// Checked new measurement of a submap.
struct SubmapUpdate {
  int32_t submap = -1;
  Span<const Sim3> T_submap_kf;
  Span<const double> log_depth_ratio;
  double center_sigma = 0.0;
  bool scale_settled = false;  ///< the guesses of TwoViewInput::log_scale_sigma are measured now
};

/// What says how long a metre is; numbers of UNISIM_METRIC_*.
enum class MetricSource : int32_t { kDistance = 0, kOdometry = 1, kHeight = 2, kModel = 3 };
inline constexpr int32_t kMetricSources = 4;

/// Checked measurement of a distance.
struct DistanceInput {
  Distance distance;
  MetricSource source = MetricSource::kDistance;
  double common_sigma = 0.0;  ///< of all of this source together, of the logarithm
};

/// Checked measurement of a submap's unit.
struct UnitInput {
  int32_t submap = -1;
  double metres = 0.0;  ///< in one unit of its prediction as it was last measured
  double sigma = 0.0;   ///< of its logarithm
  MetricSource source = MetricSource::kModel;
  double common_sigma = 0.0;
};

/// How much each source has said.
struct MetricSources {
  double information[kMetricSources] = {};
  double common_sigma[kMetricSources] = {};

  void add(MetricSource source, double sigma, double common);
  void visit(Archive* archive);
  /// Variance of what the measurements of a source have in common, by their shares.
  double common_variance() const;
};

/// What is known of the metre of a segment.
struct ScaleOutput {
  double metres_per_unit = 0.0;  ///< world unit
  double sigma = 0.0;            ///< of its logarithm
};

/// Pose of a keyframe as it is given out.
struct PoseOutput {
  Sim3 T_world_kf;
  int64_t timestamp_ns = 0;
  Tracking state = Tracking::kInit;
  int32_t confidence = 0;  ///< 0 held, 1 pair only, 2 in a submap, 3 in two or a loop
  int32_t submap = -1;
  int32_t segment = -1;
};

/// How an optimisation changed the map.
struct OptimizeReport {
  LmReport lm;
  int32_t keyframes = 0;
  int32_t submaps = 0;
  int32_t bad_keyframe = -1;  ///< keyframe id of lm.bad_node
  int32_t bad_submap = -1;    ///< or submap id
  int32_t first_changed = -1;
  int32_t last_changed = -1;
  double jump_translation = 0.0;  ///< of the newest pose, world units
  double jump_rotation = 0.0;     ///< rad
  double jump_log_scale = 0.0;
};

/// Counters.
struct SessionCounts {
  int32_t posed_keyframes = 0;
  int32_t last_posed = -1;
  int32_t windows = 0;
  int32_t loops = 0;
  int32_t segments = 0;
  Counter map_revision;
  int64_t optimizations = 0;
};

/// A session in the caller's memory. It checks and measures what comes and puts it into the map;
/// what leaves the sliding window, loops that disagree and requests are in the hands of its parts.
/// Calls return kOk or leave the session as it was; a broken invariant turns every later call into
/// kInternal until reset().
class Session {
 public:
  /// Bytes, and bytes by part, of a session with this configuration.
  static Arena measure(const SessionConfig& config);
  /// @return kOk; kOutOfMemory when the memory is smaller than measure() says
  static Status create(const SessionConfig& config, void* memory, size_t bytes, Session** session);
  /// Back to the state after create.
  Status reset();
  /// From here on, and until its memory is used otherwise, the session is not live().
  void end() {
    mark_ = 0;
    Arena::give_back(memory_, memory_bytes_);
  }
  bool live() const { return mark_ == kLiveMark; }

  // ---- pairs (session/pairs.cpp)
  Status add_keyframe(int64_t timestamp_ns, int32_t* id);
  Status add_two_view(const TwoViewInput& input);

  // ---- submaps (session/submaps.cpp, session/submap_update.cpp)
  /// @param[out] id -1 when refused for its quality
  Status add_submap(const SubmapInput& input, bool is_loop, int32_t* id);
  Status update_submap(const SubmapUpdate& update);

  // ---- metric scale (session/metric.cpp)
  /// @return kOk; kRetired when a keyframe is no longer kept; kInvalidArgument for an unknown one
  Status add_distance(const DistanceInput& input);
  /// @return kOk; kRetired; kInvalidArgument for what is no window's submap
  Status add_unit(const UnitInput& input);
  /// @return kOk; kNotReady when nothing is known of the segment's scale
  Status scale(int32_t segment, ScaleOutput* scale);
  const DistanceBook& distances() const { return distances_; }

  // ---- requests (map/request_schedule.cpp)
  Status next_request(uint32_t kinds, Request* request) const {
    return requests_.next(kinds, request);
  }
  Status reject_request(const Request& request);
  Status close_window() { return requests_.close_window(); }

  // ---- loops (skeleton/retire_loop.cpp)
  Status remove_loop(int32_t id) { return skeleton_.remove_loop(id); }
  Status loop_status(int32_t id, LoopStatus* status) const {
    return skeleton_.loop_status(id, status);
  }

  // ---- streaming out (skeleton/outbox.cpp)
  /// @return kOk; kNotReady when there is nothing new
  Status next_retired(Retired* retired) { return skeleton_.next_retired(retired); }

  // ---- optimisation (session/optimize.cpp)
  Status optimize(int32_t max_iterations, OptimizeReport* report);

  // ---- covariances (session/covariance.cpp)
  /// @return kOk; kRetired; kInvalidArgument for an unknown id; kNotReady when the graph has
  ///         changed since the last optimisation or the pose is held; kNumerical
  Status covariance(int32_t keyframe, Mat7* covariance);
  /// Joint covariance of the poses of `count` keyframes from `first` on, times a vector; seven
  /// numbers a keyframe, those without a pose of their own take no part.
  /// @return as covariance()
  Status multiply_covariance(int32_t first, int32_t count, const double* weights, double* products);

  // ---- saving and loading (session/snapshot.cpp)
  /// The map through a callback. It stays as it is; only the solver starts anew at the next
  /// optimisation, as that of a session that loads the map does, so that both go on alike.
  /// @return kOk; kIo when the callback says 0
  Status save(ArchiveWrite write, void* context) const;
  /// Into a session without keyframes. @return kOk; kInvalidArgument when it has some; else the
  ///         session is as after reset() and load_report() says why: kIo, kData, kCapacity
  Status load(ArchiveRead read, void* context);
  /// Of the last load().
  const LoadReport& load_report() const { return load_report_; }

  // ---- reading (session/read.cpp)
  bool broken() const { return map_.broken(); }
  const SessionConfig& config() const { return map_.config; }
  const KeyframeRing& keyframes() const { return map_.keyframes; }
  const SubmapTable& submaps() const { return map_.submaps; }
  const Graph& graph() const { return map_.graph; }
  const TrackingState& tracking() const { return tracking_; }
  const Skeleton& skeleton() const { return skeleton_; }
  const LoopWatch& loop_watch() const { return watch_; }
  const SessionCounts& counts() const { return counts_; }
  const Refusals& refusals() const { return refusals_; }
  size_t arena_bytes() const { return memory_bytes_; }
  size_t arena_used_bytes() const { return used_bytes_; }
  /// Keyframes in the graph.
  int32_t live_nodes() const { return counts_.posed_keyframes - skeleton_.counts().keyframes; }
  /// @return kOk; kInvalidArgument for an unknown id; kRetired when it is no longer kept; kNotReady
  ///         when it has no pose yet
  Status pose(int32_t keyframe, PoseOutput* pose) const;
  /// Latest pose; the submap has a node.
  Sim3 submap_pose(const Submap& submap) const { return map_.submap_pose(submap); }
  bool has_pose(int32_t keyframe) const { return map_.keyframes.pose_source(keyframe) >= 0; }

 private:
  Session(const SessionConfig& config, const SessionCapacity& capacity, Arena& arena);

  // session/pairs.cpp
  Status check_gap(int32_t i, int32_t j) const;
  void accept_pair(const TwoViewInput& input, double log_ratio, double multiplier);
  void refuse_pair(int32_t j, RefusalReason reason, double value = 0.0, double limit = 0.0);
  void start_segment(int32_t keyframe, const Sim3& T_world_kf);
  void give_node(int32_t keyframe, const Sim3& T_world_kf, int32_t segment);
  void make_keyframe_room();
  void make_node_room();
  void refuse_late_windows();
  double quality_multiplier(double sigma) const;
  bool has_ids() const {
    return map_.keyframes.size() <= kLastId && map_.submaps.next_id() <= kLastId;
  }

  // session/scale_doubt.cpp
  double window_multiplier(const Submap& submap) const;
  void weigh_views(const Submap& submap);
  void settle_scale(const KeyframeRange& between);

  // session/submaps.cpp
  Status check_views(const SubmapInput& input, bool is_loop, int32_t* window) const;
  void measure_views(const SubmapInput& input, bool is_loop, Submap* submap);
  void measure_view(const DepthMap& depth, bool is_window, SubmapView* view);
  void find_shared(SubmapView* view);
  bool choose_origin(Submap* submap);
  bool judge_submap(Submap* submap);
  bool is_in_range(const Submap& submap) const;
  void refuse_submap(const Submap& submap, RefusalReason reason, double value = 0.0,
                     double limit = 0.0);
  void refuse_window(const Window& window, RefusalReason reason);
  void connect(const SubmapInput& input, int32_t id, const Window& window);
  void adopt_views(const SubmapInput& input, const Submap& submap);
  void keep_shared_depth(const SubmapInput& input, int32_t id, const Window& window);
  void count_cover(int32_t id);

  // session/segments.cpp
  Sim3 first_pose(const Submap& submap) const;
  void place_submap(Submap* submap);
  const SubmapView& joining_view(const Submap& submap, int32_t segment) const;
  Sim3 join_correction(const SubmapView& view, const Sim3& T_world_submap) const;
  bool joins_in_range(const Submap& submap, const Sim3& T_world_submap, int32_t segment) const;
  void join_segment(const Submap& submap, int32_t segment, int32_t into);
  void move_retired(int32_t segment, const Sim3& correction);

  // session/metric.cpp
  Status show_metres();
  Status measure_metre(int32_t segment);
  void measure_new_metres();

  // session/submap_update.cpp
  bool is_in_range(const SubmapUpdate& update, const Submap& submap) const;
  void update_views(const SubmapUpdate& update, Submap* submap);
  void set_bridge_measurement(const SubmapView& view);

  // session/snapshot.cpp
  void visit(Archive* archive);
  void visit_settings(Archive* archive);
  void visit_session(Archive* archive);
  bool counts_hold() const;
  bool depth_holds() const;

  // session/covariance.cpp
  int32_t carrier(const Keyframe& keyframe) const;
  Mat7 carried(const Keyframe& keyframe) const;
  double own_variance(const Keyframe& keyframe) const;
  double told_variance() const;

  // session/optimize.cpp
  void describe_changes(uint64_t revision_before, OptimizeReport* report);
  void describe_bad_node(OptimizeReport* report) const;

  bool holds(Status status) { return map_.holds(status); }

  size_t memory_bytes_ = 0;
  void* memory_ = nullptr;
  size_t used_bytes_ = 0;
  static constexpr uint32_t kLiveMark = 0x756e6973;  // unlikely in memory of another use
  uint32_t mark_ = kLiveMark;
  int32_t live_nodes_capacity_ = 0;

  Map map_;
  RequestSchedule requests_;
  TrackingState tracking_;
  DepthBook depth_;
  SampledDepth sampled_;  // the map being compared or kept
  TieEdges ties_;
  Gauge gauge_;
  mutable LevenbergMarquardt solver_;  // what it keeps is no part of the map
  Span<Sim3> before_;                  // poses before an optimisation, by node
  LoopWatch watch_;
  Skeleton skeleton_;

  DistanceBook distances_;
  MetricSources sources_;
  SessionCounts counts_;
  Refusals refusals_;
  LoadReport load_report_;
  int32_t first_of_run_;  // keyframe; older ones were loaded, with the times of another run
  int32_t next_segment_ = 0;
  bool window_came_ = false;      // since the last optimisation
  uint64_t solved_revision_ = 0;  // of the graph at the end of the last optimisation
  double variance_factor_ = 0.0;  // of that optimisation
};

}  // namespace unisim
