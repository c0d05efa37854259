// SPDX-License-Identifier: MIT
// The session: wires keyframes, submaps, depth, graph and solver; the one class that capi sees.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/base/arena.hpp"
#include "core/base/counter.hpp"
#include "core/base/status.hpp"
#include "core/graph/graph.hpp"
#include "core/map/depth_book.hpp"
#include "core/map/gauge.hpp"
#include "core/map/keyframe_ring.hpp"
#include "core/map/loop_edge.hpp"
#include "core/map/submap_table.hpp"
#include "core/map/submap_window.hpp"
#include "core/map/tracking_state.hpp"
#include "core/session/refusals.hpp"
#include "core/session/session_config.hpp"
#include "core/solve/condenser.hpp"
#include "core/solve/lm.hpp"

namespace unisim {

/// Checked two-view prediction.
struct TwoViewInput {
  int32_t i = 0;
  int32_t j = 0;
  Sim3 T_i_j;  ///< scale 1
  DepthMap depth_i;
  DepthMap depth_j;
  double center_sigma = 0.0;  ///< >= 0, 0: not known
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
};

/// Kinds of predictions, bits of UNISIM_REQUEST_*.
inline constexpr uint32_t kRequestPair = 1;
inline constexpr uint32_t kRequestWindow = 2;

/// A wanted prediction: keyframes first .. first + count - 1.
struct Request {
  uint32_t kind = 0;
  Window keyframes;
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

/// A node of the skeleton.
struct SkeletonNode {
  int32_t submap = -1;       ///< window whose node it is
  int32_t windows = 0;       ///< that hang on it, itself included
  int32_t first_owned = -1;  ///< keyframes that hang on it lie in first..last, -1: none
  int32_t last_owned = -1;
};

/// What has left the window, as it is offered once.
struct Retired {
  int32_t keyframe = -1;  ///< -1: a submap that has become rigid
  int64_t timestamp_ns = 0;
  int32_t submap = -1;  ///< the keyframe's owner, or the submap that has become rigid
  int32_t anchor = -1;  ///< of a submap: the one it hangs on from now on
  Sim3 T;               ///< T_submap_kf or T_anchor_submap, scale included
  int32_t confidence = 0;
  int32_t segment = -1;
};

/// Numbers of UNISIM_LOOP_*.
enum class LoopState : int32_t { kActive = 0, kSuspended = 1, kRigid = 2, kRemoved = 3 };

/// How a loop stands.
struct LoopStatus {
  LoopState state = LoopState::kActive;
  bool condensed = false;  ///< its keyframes have left the window
  double norm = 0.0;       ///< whitened residual after the last optimisation
};

/// Counters.
struct SessionCounts {
  int32_t posed_keyframes = 0;
  int32_t last_posed = -1;
  int32_t windows = 0;
  int32_t loops = 0;
  int32_t segments = 0;
  Counter map_revision;
  int32_t retired_keyframes = 0;
  int32_t retired_loops = 0;
  int32_t retired_windows = 0;
  int32_t suspended_loops = 0;  ///< now
  Counter loop_suspensions;     ///< so far
  Counter loop_returns;         ///< suspended ones that agreed again
  int32_t loops_removed = 0;    ///< by the host
  int32_t loops_dropped = 0;    ///< given up to stay within memory
  int32_t stretches = 0;        ///< of keyframes that no window came for
  int32_t retired_unread = 0;   ///< gone before they were asked for
  int32_t live_nodes = 0;       ///< keyframes in the graph
  int64_t optimizations = 0;
};

/// A session in the caller's memory. Calls return kOk or leave the session as it was; a broken
/// invariant turns every later call into kInternal until reset().
class Session {
 public:
  /// Bytes, and bytes by part, of a session with this configuration.
  static Arena measure(const SessionConfig& config);
  /// @return kOk; kOutOfMemory when the memory is smaller than measure() says
  static Status create(const SessionConfig& config, void* memory, size_t bytes, Session** session);
  /// Back to the state after create.
  Status reset();
  /// From here on, and until its memory is used otherwise, the session is not live().
  void end() { mark_ = 0; }
  bool live() const { return mark_ == kLiveMark; }

  // ---- pairs (session/pairs.cpp)
  Status add_keyframe(int64_t timestamp_ns, int32_t* id);
  Status add_two_view(const TwoViewInput& input);

  // ---- submaps (session/submaps.cpp, session/submap_edges.cpp, session/revision.cpp)
  /// @param[out] id -1 when refused for its quality
  Status add_submap(const SubmapInput& input, bool is_loop, int32_t* id);
  Status update_submap(const SubmapUpdate& update);

  // ---- requests (session/requests.cpp)
  Status next_request(uint32_t kinds, Request* request) const;
  Status reject_request(const Request& request);
  Status close_window();

  // ---- loops (session/robust_loops.cpp)
  Status remove_loop(int32_t id);
  Status loop_status(int32_t id, LoopStatus* status) const;

  // ---- streaming out (session/retired.cpp)
  /// @return kOk; kNotReady when there is nothing new
  Status next_retired(Retired* retired);

  // ---- optimisation (session/optimize.cpp)
  Status optimize(int32_t max_iterations, OptimizeReport* report);
  Status covariance(int32_t keyframe, Mat7* covariance);

  // ---- reading (session/read.cpp)
  bool broken() const { return broken_; }
  const SessionConfig& config() const { return config_; }
  const KeyframeRing& keyframes() const { return keyframes_; }
  const SubmapTable& submaps() const { return submaps_; }
  const Graph& graph() const { return graph_; }
  const TrackingState& tracking() const { return tracking_; }
  SessionCounts counts() const { return counts_; }
  const Refusals& refusals() const { return refusals_; }
  size_t arena_bytes() const { return memory_bytes_; }
  size_t arena_used_bytes() const { return used_bytes_; }
  /// @return kOk; kInvalidArgument for an unknown id; kRetired when it is no longer kept; kNotReady
  ///         when it has no pose yet
  Status pose(int32_t keyframe, PoseOutput* pose) const;
  /// Latest pose; the keyframe is posed().
  Sim3 keyframe_pose(int32_t keyframe) const;
  Sim3 submap_pose(const Submap& submap) const;
  bool has_pose(int32_t keyframe) const { return keyframes_.pose_source(keyframe) >= 0; }

 private:
  Session(const SessionConfig& config, const SessionCapacity& capacity, Arena& arena);

  void accept_pair(const TwoViewInput& input, double log_ratio, double multiplier);
  void refuse_pair(int32_t j, RefusalReason reason, double value = 0.0, double limit = 0.0);
  void start_segment(int32_t keyframe, const Sim3& T_world_kf);
  void give_node(int32_t keyframe, const Sim3& T_world_kf, int32_t segment);

  Status check_views(const SubmapInput& input, bool is_loop, int32_t* window) const;
  void measure_views(const SubmapInput& input, bool is_loop, Submap* submap);
  void measure_view(const DepthMap& depth, bool may_adopt, bool may_share, SubmapView* view);
  bool choose_origin(Submap* submap);
  bool judge_submap(Submap* submap);
  bool is_in_range(const Submap& submap) const;
  void refuse_submap(const Submap& submap, RefusalReason reason, double value = 0.0,
                     double limit = 0.0);
  void refuse_window(const Window& window, RefusalReason reason);
  void place_submap(Submap* submap);
  Sim3 first_pose(const Submap& submap) const;
  const SubmapView& joining_view(const Submap& submap, int32_t segment) const;
  Sim3 join_correction(const SubmapView& view, const Sim3& T_world_submap) const;
  bool joins_in_range(const Submap& submap, const Sim3& T_world_submap, int32_t segment) const;
  void join_segment(const Submap& submap, int32_t segment, int32_t into);
  void adopt_views(const SubmapInput& input, const Submap& submap);
  void move_retired(int32_t segment, const Sim3& correction);
  void add_view_edges(int32_t id);
  void attach_view(const Submap& submap, SubmapView* view);
  void add_shared_edges(int32_t id);
  bool take_window_pair(int32_t m, int32_t n);
  void add_scale_edge(int32_t m, int32_t n);
  void keep_shared_depth(const SubmapInput& input, int32_t id, const Window& window);
  void count_cover(int32_t id);
  bool is_in_range(const SubmapUpdate& update, const Submap& submap) const;
  void update_views(const SubmapUpdate& update, Submap* submap);
  void set_bridge_measurement(const SubmapView& view);
  void update_shared(const SubmapUpdate& update);
  double median_log_c(int32_t m, int32_t n);

  // session/make_room.cpp
  bool slides() const { return config_.window_submaps > 0; }
  void make_keyframe_room();
  void make_node_room();
  bool close_stretch();
  int32_t first_uncovered() const;
  void make_submap_room(bool is_loop);
  void forget_window();
  void forget_loop();
  void forget_part();

  // session/retire.cpp
  void retire_surplus(int32_t newest);
  void retire_oldest();
  void retire_last();
  void retire_submap(int32_t m, int32_t n, int32_t end);
  bool condense_windows(const Submap& m, const Submap& n, ChainLink* link);
  bool load_between(const Submap& m, const Submap& n);
  void guess_link(const Submap& m, const Submap& n, ChainLink* link) const;
  void add_link(int32_t a, int32_t b, const ChainLink& link);
  void drop_edges(int32_t id);
  void count_window_pairs();
  void retire_keyframe(int32_t id, int32_t m, int32_t n);
  void note_owned(Submap* carrier, int32_t keyframe);
  int32_t owner_of(int32_t id, int32_t m, int32_t n) const;
  void drop_windows_before(int32_t keyframe);

  // session/retire_loop.cpp
  void retire_loops();
  bool all_retired(const Submap& submap) const;
  void condense_early(int32_t id);
  void retire_loop(int32_t id);
  bool condense_loop(const Submap& loop, int32_t a, int32_t b, int32_t split, ChainLink* link);
  int32_t split_view(const Submap& loop) const;
  int32_t node_under(int32_t keyframe) const;
  int32_t main_node(const Submap& loop, int32_t begin, int32_t end) const;

  // session/merge.cpp
  void bound_skeleton();
  int32_t cheapest_merge() const;
  void merge_skeleton(int32_t place);
  void erase_skeleton(int32_t place);
  void hang_submaps(int32_t a, int32_t b, const Sim3& T_a_b);
  void move_chain_edges(int32_t a, int32_t b, const Sim3& T_a_b);
  int32_t replace_chain(int32_t id, int32_t a, int32_t b, const ChainLink& link);
  void detach_loop_views(int32_t node);
  void attach_loop_views();

  // session/loop_edges.cpp
  void add_loop_edge(int32_t a, int32_t b, const ChainLink& link, Submap* loop);
  int32_t fusible_edge(int32_t a, int32_t b, const ChainLink& link, int32_t but) const;
  void fuse_loop_edge(int32_t place, const ChainLink& link);
  void fuse_loop_edges(int32_t node);
  void release_loop_edge(int32_t place, int32_t into);
  void drop_loop_edge(int32_t place);
  int32_t loop_edge_at(int32_t edge) const;
  int32_t weakest_loop_edge();
  bool untangle();

  // session/robust_loops.cpp
  void judge_loops();
  void judge(LoopHealth* health, int32_t loop, double norm);
  double loop_norm(const Submap& loop) const;
  void suspend_edge(int32_t edge, bool suspended);
  void suspend_edges(const Submap& loop, bool suspended);
  void place_again(Submap* loop);

  Sim3 view_measurement(const SubmapView& view) const;
  Sim3 shared_measurement(const SharedKeyframe& shared) const;
  double quality_multiplier(double center_sigma) const;
  EdgeWeight edge_weight(FactorKind kind, double multiplier, EdgeOrigin origin) const;
  bool has_ids() const { return keyframes_.size() <= kLastId && submaps_.next_id() <= kLastId; }
  int32_t settled_for_windows() const;
  void describe_changes(OptimizeReport* report);
  void describe_bad_node(OptimizeReport* report) const;
  /// Remember that an invariant is broken when `status` is not kOk.
  bool holds(Status status);

  SessionConfig config_;
  size_t memory_bytes_ = 0;
  void* memory_ = nullptr;
  size_t used_bytes_ = 0;
  static constexpr uint32_t kLiveMark = 0x756e6973;  // unlikely in memory of another use
  uint32_t mark_ = kLiveMark;
  bool broken_ = false;

  KeyframeRing keyframes_;
  WindowSchedule windows_;
  SubmapTable submaps_;
  TrackingState tracking_;
  DepthBook depth_;
  SampledDepth sampled_;  // the map being compared or kept
  Graph graph_;
  Gauge gauge_;
  LevenbergMarquardt solver_;
  Span<Sim3> before_;  // poses before an optimisation, by node

  // The skeleton; empty in the full batch.
  FixedVector<int32_t> live_windows_;  // windows that still have their keyframes, oldest first
  FixedVector<int32_t> live_loops_;
  FixedVector<SkeletonNode> skeleton_;  // in time order
  FixedVector<LoopEdge> loop_edges_;
  Span<Retired> merges_;  // ring of those to offer
  Condenser condenser_;
  Span<int32_t> local_node_;  // node -> node of the condenser's graph, -1: not in it
  Span<int32_t> place_;       // node -> place in time among skeleton and window
  int32_t live_from_ = 0;     // older keyframes have retired
  int32_t offered_ = 0;       // older keyframes have been offered
  int32_t merges_made_ = 0;
  int32_t merges_offered_ = 0;
  int32_t live_nodes_capacity_ = 0;
  int32_t skeleton_capacity_ = 0;

  SessionCounts counts_;
  Refusals refusals_;
  int32_t settled_ = 0;    // last keyframe whose pair with the one before is settled
  int32_t closed_at_ = 0;  // keyframes there were at the last close_window()
  int32_t window_pair_capacity_ = 0;
  int32_t window_pairs_ = 0;  // pairs of submaps that share keyframes
  int32_t next_segment_ = 0;
  bool window_came_ = false;      // since the last optimisation
  bool skeleton_is_due_ = true;   // since it was optimised a loop has come, gone or changed
  uint64_t solved_revision_ = 0;  // of the graph at the end of the last optimisation
  double variance_factor_ = 0.0;  // of that optimisation
};

}  // namespace unisim
