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

Session::Session(const SessionConfig& config, Arena& arena)
    : config_(config),
      keyframes_(part(arena, "keyframes"), config.max_keyframes),
      windows_(part(arena, "windows"), config.window_size, config.window_overlap,
               session_capacity(config).windows),
      submaps_(part(arena, "submaps"), session_capacity(config).submaps,
               session_capacity(config).views, session_capacity(config).shared),
      tracking_(config.lost_after),
      depth_(part(arena, "depth"), session_capacity(config).depth, config.confidence_drop),
      graph_(part(arena, "graph"), session_capacity(config).graph),
      gauge_(arena, session_capacity(config).graph.nodes),
      solver_(part(arena, "solver"), session_capacity(config).solver),
      before_(part(arena, "poses before").take<Sim3>(config.max_keyframes)),
      window_pair_capacity_(session_capacity(config).window_pairs) {}

Arena Session::measure(const SessionConfig& config) {
  Arena arena;
  static_cast<void>(take_session(arena));
  const Session dry(config, arena);
  return arena;
}

Status Session::create(const SessionConfig& config, void* memory, size_t bytes, Session** session) {
  Arena arena(memory, bytes);
  if (bytes < measure(config).required_bytes()) return Status::kOutOfMemory;
  const Span<unsigned char> place = take_session(arena);
  if (place.data() == nullptr) return Status::kOutOfMemory;
  auto* made = ::new (static_cast<void*>(place.data())) Session(config, arena);
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
