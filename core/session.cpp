// SPDX-License-Identifier: MIT
// Memory layout and life cycle of a session.
#include "core/session.hpp"

#include <new>

namespace unisim {
namespace {

// Members are laid out in the order of their declaration; each says under which name it is counted.
Arena& part(Arena& arena, const char* name) {
  arena.begin_part(name);
  return arena;
}

Span<unsigned char> take_session(Arena& arena) {
  return part(arena, "session").take<unsigned char>(static_cast<int32_t>(sizeof(Session)));
}

}  // namespace

Session::Session(const SessionConfig& config, const SessionCapacity& capacity, Arena& arena)
    : config_(config),
      keyframes_(part(arena, "keyframes"), capacity.keyframes, config.first_keyframe_id),
      windows_(part(arena, "windows"), config.window_size, config.window_overlap,
               capacity.open_windows, config.window_submaps > 0, config.first_keyframe_id),
      submaps_(part(arena, "submaps"), capacity.submaps, config.first_submap_id),
      tracking_(config.lost_after),
      depth_(part(arena, "depth"), capacity.depth, config.confidence_drop),
      sampled_(arena, config.grid),
      graph_(part(arena, "graph"), capacity.graph),
      gauge_(arena, capacity.graph.nodes),
      solver_(part(arena, "solver"), capacity.solver),
      before_(part(arena, "poses before").take<Sim3>(capacity.graph.nodes)),
      live_windows_(part(arena, "skeleton"), capacity.live_windows),
      live_loops_(arena, capacity.live_loops),
      skeleton_(arena, capacity.skeleton > 0 ? capacity.skeleton + 1 : 0),
      loop_edges_(arena, capacity.loop_edges),
      merges_(arena.take<Retired>(capacity.merges)),
      condenser_(part(arena, "condenser"), capacity.condenser),
      local_node_(arena.take<int32_t>(capacity.live_windows > 0 ? capacity.graph.nodes : 0)),
      place_(arena.take<int32_t>(local_node_.size())),
      live_from_(config.first_keyframe_id),
      offered_(config.first_keyframe_id),
      live_nodes_capacity_(capacity.live_nodes),
      skeleton_capacity_(capacity.skeleton),
      refusals_(config.log),
      settled_(config.first_keyframe_id),
      closed_at_(config.first_keyframe_id),
      window_pair_capacity_(capacity.window_pairs) {}

Arena Session::measure(const SessionConfig& config) {
  Arena arena;
  static_cast<void>(take_session(arena));
  const Session dry(config, session_capacity(config), arena);
  return arena;
}

Status Session::create(const SessionConfig& config, void* memory, size_t bytes, Session** session) {
  Arena arena(memory, bytes);
  if (bytes < measure(config).required_bytes()) return Status::kOutOfMemory;
  const Span<unsigned char> place = take_session(arena);
  if (place.data() == nullptr) return Status::kOutOfMemory;
  auto* made =
      ::new (static_cast<void*>(place.data())) Session(config, session_capacity(config), arena);
  made->memory_ = memory;
  made->memory_bytes_ = bytes;
  made->used_bytes_ = arena.used_bytes();
  *session = made;
  return Status::kOk;
}

Status Session::reset() {
  const SessionConfig config = config_;
  Session* same = nullptr;
  return create(config, memory_, memory_bytes_, &same);
}

bool Session::holds(Status status) {
  if (!is_ok(status)) broken_ = true;
  UNISIM_CHECK(!broken_);
  return !broken_;
}

}  // namespace unisim
