// SPDX-License-Identifier: MIT
// A session's map saved and loaded.
#include <limits>

#include "core/session.hpp"

namespace unisim {
namespace {

Status status_of(LoadProblem problem) {
  switch (problem) {
    case LoadProblem::kNone:
      return Status::kOk;
    case LoadProblem::kEnd:
      return Status::kIo;
    case LoadProblem::kCapacity:
    case LoadProblem::kSetting:
      return Status::kCapacity;
    case LoadProblem::kMagic:
    case LoadProblem::kVersion:
    case LoadProblem::kChecksum:
    case LoadProblem::kContent:
      break;
  }
  return Status::kData;
}

}  // namespace

Status Session::save(ArchiveWrite write, void* context) const {
  solver_.forget();
  Archive archive(write, context);
  // One visit serves both ways; an archive that saves only reads what it visits.
  const_cast<Session*>(this)->visit(&archive);
  return archive.ok() ? Status::kOk : Status::kIo;
}

Status Session::load(ArchiveRead read, void* context) {
  if (map_.keyframes.size() != map_.config.first_keyframe_id) return Status::kInvalidArgument;
  Archive archive(read, context);
  visit(&archive);
  if (archive.ok()) {
    load_report_ = LoadReport();
    first_of_run_ = map_.keyframes.size();
    return Status::kOk;
  }
  const SessionConfig config = map_.config;
  Session* fresh = nullptr;
  const Status status = create(config, memory_, memory_bytes_, &fresh);
  if (!is_ok(status)) return status;
  fresh->load_report_ = archive.report();
  return status_of(archive.report().problem);
}

/// What others refer to comes before them.
void Session::visit(Archive* archive) {
  Graph* graph = &map_.graph;
  archive->magic();
  archive->section("settings", [&] { visit_settings(archive); });
  archive->section("graph", [&] { graph->visit_sizes(archive); });
  archive->section("keyframe", [&] { map_.keyframes.visit(archive, graph); });
  archive->section("submaps", [&] { map_.submaps.visit(archive, graph); });
  archive->section("skeleton", [&] { skeleton_.visit(archive); });
  archive->section("edges", [&] {
    skeleton_.visit_edges(archive);
    map_.metric.visit(archive, graph);
    graph->visit_free_slots(archive);
  });
  archive->section("metric", [&] {
    distances_.visit(archive);
    sources_.visit(archive);
  });
  archive->section("requests", [&] { requests_.visit(archive); });
  archive->section("depth", [&] {
    depth_.visit(archive, map_.keyframes.first(), map_.keyframes.size());
    if (archive->loading() && archive->ok()) archive->expect(depth_holds());
  });
  archive->section("session", [&] { visit_session(archive); });
}

/// What the numbers of a map mean depends on some; lengths on others.
void Session::visit_settings(Archive* archive) {
  const SessionConfig& config = map_.config;
  const SessionCapacity capacity = session_capacity(config);
  archive->same("preset", static_cast<int32_t>(config.preset));
  archive->same("depth_grid_width", config.grid.width);
  archive->same("depth_grid_height", config.grid.height);
  int32_t windows = config.window_submaps;
  archive->value(&windows);
  archive->fits("window_submaps", (windows > 0) == config.slides(), windows, config.window_submaps);
  archive->need("window_submaps", windows, config.window_submaps);
  archive->at_least("window_size", config.window_size);
  archive->at_least("window_overlap", config.window_overlap);
  archive->at_least("skeleton_capacity", capacity.skeleton);
}

void Session::visit_session(Archive* archive) {
  archive->index(&counts_.posed_keyframes, 0, kMostCount);
  archive->index(&counts_.last_posed, -1, map_.keyframes.size() - 1);
  archive->index(&counts_.windows, 0, kMostCount);
  archive->index(&counts_.loops, 0, kMostCount);
  archive->index(&counts_.segments, 0, kMostCount);
  counts_.map_revision.visit(archive);
  archive->value(&counts_.optimizations);
  archive->expect(counts_.optimizations >= 0 &&
                  counts_.optimizations < std::numeric_limits<int64_t>::max() / 2);
  archive->index(&next_segment_, 0, kMostCount);
  archive->flag(&window_came_);
  bool solved = solved_revision_ == map_.graph.revision();
  archive->flag(&solved);
  archive->value(&variance_factor_);
  tracking_.visit(archive);
  refusals_.visit(archive);
  if (!archive->loading() || !archive->ok()) return;
  solved_revision_ = solved ? map_.graph.revision() : 0;
  archive->expect(counts_hold());
}

bool Session::counts_hold() const {
  int32_t live = 0;
  for (int32_t id = map_.keyframes.first(); id < map_.keyframes.size(); ++id) {
    const Keyframe& keyframe = map_.keyframes[id];
    if (keyframe.segment >= next_segment_) return false;
    live += keyframe.node >= 0 ? 1 : 0;
  }
  for (int32_t k = 0; k < map_.submaps.size(); ++k) {
    if (map_.submaps.at(k).segment >= next_segment_) return false;
  }
  // Windows that have their keyframes may keep some more than that from leaving.
  const int32_t most = live_nodes_capacity_ + map_.config.window_submaps;
  return live == live_nodes() && live <= most;
}

/// What is compared with a view of a submap is of a view that is there.
bool Session::depth_holds() const {
  for (const DepthStore::Source& source : depth_.submap_sources()) {
    const bool compared = source.keyframe >= 0 && map_.submaps.has(source.submap) &&
                          !map_.submaps[source.submap].place.retired;
    if (compared && !map_.submaps.has_view(source.submap, source.view)) return false;
  }
  return true;
}

}  // namespace unisim
