// SPDX-License-Identifier: MIT
// Memory layout and life cycle of a session.
#include "core/session.hpp"

#include <new>

namespace unisim {
namespace {

Span<unsigned char> take_session(Arena& arena) {
  for (const char* name : {"session", "keyframes", "windows", "submaps", "depth", "graph", "solver",
                           "poses before", "skeleton", "condenser", "metric"}) {
    arena.begin_part(name);
  }
  return arena.begin_part("session").take<unsigned char>(static_cast<int32_t>(sizeof(Session)));
}

}  // namespace

// Members are laid out in the order of their declaration; each says under which name it is counted.
Session::Session(const SessionConfig& config, const SessionCapacity& capacity, Arena& arena)
    : live_nodes_capacity_(capacity.live_nodes),
      map_(arena, config, capacity),
      requests_(
          map_.keyframes,
          WindowSchedule(arena.begin_part("windows"), config.window_size, config.window_overlap,
                         capacity.open_windows, config.slides(), config.first_keyframe_id),
          config.preset == Preset::kPaper),
      tracking_(config.lost_after),
      depth_(arena.begin_part("depth"), capacity.depth, config.confidence_drop),
      sampled_(arena, config.grid),
      ties_(map_, capacity.window_pairs),
      gauge_(arena.begin_part("graph"), capacity.graph.nodes),
      solver_(arena.begin_part("solver"), capacity.solver),
      before_(arena.begin_part("poses before").take<Sim3>(capacity.graph.nodes)),
      watch_(map_),
      skeleton_(arena, capacity, map_, ties_, watch_),
      distances_(arena.begin_part("metric"), capacity.graph.nodes, map_),
      refusals_(map_.config.log),
      first_of_run_(config.first_keyframe_id) {}

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
  const SessionConfig config = map_.config;
  Session* same = nullptr;
  return create(config, memory_, memory_bytes_, &same);
}

}  // namespace unisim
