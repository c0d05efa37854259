// SPDX-License-Identifier: MIT
// The map of a session saved, and loaded into another one.
#include "tools/bench/walk/snapshot_run.hpp"

#include <cstring>
#include <string>
#include <vector>

#include "tools/bench/process.hpp"
#include "tools/common/failure.hpp"

namespace unisim::bench {
namespace {

void expect_ok(unisim_status status, const char* call) {
  if (status == UNISIM_OK) return;
  throw tools::Failure(tools::kExitLimit, std::string(call) + ": " + unisim_status_string(status));
}

/// A snapshot in memory that is there before it is needed.
struct Stream {
  std::vector<unsigned char> bytes;
  size_t at = 0;

  static int32_t count(void* context, const void* /*bytes*/, size_t size) {
    *static_cast<size_t*>(context) += size;
    return 1;
  }
  static int32_t write(void* context, const void* from, size_t size) {
    auto* self = static_cast<Stream*>(context);
    if (self->bytes.size() - self->at < size) return 0;
    std::memcpy(self->bytes.data() + self->at, from, size);
    self->at += size;
    return 1;
  }
  static int32_t read(void* context, void* to, size_t size) {
    auto* self = static_cast<Stream*>(context);
    if (self->bytes.size() - self->at < size) return 0;
    std::memcpy(to, self->bytes.data() + self->at, size);
    self->at += size;
    return 1;
  }
};

double save(const unisim_session* session, const pipeline::HeapWatch& heap, Stream* stream) {
  stream->at = 0;
  const double start = process_cpu_ms();
  const pipeline::InsideLibrary inside(heap);
  expect_ok(unisim_save_map(session, Stream::write, stream), "unisim_save_map");
  return process_cpu_ms() - start;
}

}  // namespace

SnapshotResult run_snapshot(const unisim_session* session, const unisim_config& config,
                            const pipeline::HeapWatch& heap) {
  SnapshotResult result;
  expect_ok(unisim_save_map(session, Stream::count, &result.bytes), "unisim_save_map");
  Stream saved;
  saved.bytes.resize(result.bytes);
  result.save_ms = save(session, heap, &saved);

  size_t size = 0;
  expect_ok(unisim_arena_size(&config, &size), "unisim_arena_size");
  std::vector<unsigned char> arena(size);
  unisim_session* loaded = nullptr;
  expect_ok(unisim_session_create(&loaded, &config, arena.data(), size), "unisim_session_create");
  saved.at = 0;
  const double start = process_cpu_ms();
  {
    const pipeline::InsideLibrary inside(heap);
    expect_ok(unisim_load_map(loaded, Stream::read, &saved), "unisim_load_map");
  }
  result.load_ms = process_cpu_ms() - start;
  Stream again;
  again.bytes.resize(result.bytes);
  save(loaded, heap, &again);
  unisim_session_destroy(loaded);
  if (again.bytes != saved.bytes) {
    throw tools::Failure(tools::kExitOther, "the map loaded is not the one that was saved");
  }
  return result;
}

}  // namespace unisim::bench
