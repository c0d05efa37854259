// SPDX-License-Identifier: MIT
// What is known of the metre saved and loaded: evidence by node, metres and their edges, distances.
#include <cmath>

#include "core/map/distance_book.hpp"
#include "core/map/metric_scale.hpp"
#include "core/session_config.hpp"

namespace unisim {
namespace {

void visit_evidence(Archive* archive, ScaleEvidence* evidence) {
  archive->finite(&evidence->log_metres);
  archive->finite(&evidence->information);
  archive->expect(evidence->information >= 0.0);
}

void visit_counts(Archive* archive, DistanceCounts* counts) {
  archive->index(&counts->taken, 0, kMostCount);
  archive->index(&counts->refused, 0, kMostCount);
  archive->index(&counts->lost, 0, kMostCount);
}

void visit_positive(Archive* archive, double* value) {
  archive->finite(value);
  archive->expect(*value > 0.0);
}

}  // namespace

void MetricScale::visit(Archive* archive, Graph* graph) {
  archive->flag(&used_);
  visit_positive(archive, &unit_variance_);
  visit_metres(archive, graph);
  const auto has_something = [&](int32_t node) {
    const NodeEvidence& here = evidence_[node];
    return here.kept.known() || here.open.known() || here.edge >= 0;
  };
  int32_t count = 0;
  for (int32_t node = 0; !archive->loading() && node < evidence_.size(); ++node) {
    count += has_something(node) ? 1 : 0;
  }
  archive->index(&count, 0, evidence_.size());
  int32_t next = 0;
  for (int32_t k = 0; archive->ok() && k < count; ++k) {
    while (!archive->loading() && !has_something(next)) ++next;
    int32_t node = next;
    archive->index(&node, next, evidence_.size() - 1);
    if (!archive->ok()) return;
    visit_node(archive, node, graph);
    next = node + 1;
  }
}

void MetricScale::visit_metres(Archive* archive, Graph* graph) {
  int32_t count = metres_.size();
  archive->index(&count, 0, kMostMetres);
  if (archive->loading()) metres_.resize(archive->ok() ? count : 0);
  for (int32_t k = 0; archive->ok() && k < count; ++k) {
    Metre& metre = metres_[k];
    if (archive->loading()) metre = Metre();
    archive->index(&metre.segment, 0, kLastId);
    archive->finite(&metre.sigma);
    graph->visit_node(archive, NodeKind::kMetre, &metre.node);
    if (archive->ok()) archive->expect(!graph->node(metre.node).fixed);
  }
}

void MetricScale::visit_node(Archive* archive, int32_t node, Graph* graph) {
  const bool carries = graph->has_node(node) && (graph->node(node).kind == NodeKind::kSubmap ||
                                                 graph->node(node).kind == NodeKind::kSkeleton);
  archive->expect(carries);
  NodeEvidence& here = evidence_[node];
  visit_evidence(archive, &here.kept);
  visit_evidence(archive, &here.open);
  archive->finite(&here.shown_variance);
  int32_t slot = -1;
  for (int32_t k = 0; k < metres_.size(); ++k) {
    if (here.metre >= 0 && metres_[k].node == here.metre) slot = k;
  }
  archive->index(&slot, -1, metres_.size() - 1);
  if (archive->loading()) here.metre = archive->ok() && slot >= 0 ? metres_[slot].node : -1;
  if (here.metre < 0 || !archive->ok()) return;
  graph->visit_edge(archive, FactorKind::kMetric, here.metre, node, &here.edge);
  archive->expect(here.edge >= 0);
  if (!archive->ok()) return;
  const Edge& edge = graph->edge(here.edge);
  archive->expect(edge.weight() > 0.0 && !edge.suspended);
}

void DistanceBook::visit(Archive* archive) {
  visit_counts(archive, &counts_);
  archive->index(&solved_submaps_, 0, map_.submaps.next_id());
  archive->index(&remembered_, 0, 2 * kMemory - 1);
  for (Remembered& old : memory_) {
    archive->index(&old.segment, -1, kLastId);
    visit_evidence(archive, &old.world);
  }
  int32_t count = distances_.size();
  archive->index(&count, 0, kMost);
  if (archive->loading()) distances_.resize(archive->ok() ? count : 0);
  for (int32_t k = 0; archive->ok() && k < count; ++k) visit_entry(archive, &distances_[k]);
}

void DistanceBook::visit_entry(Archive* archive, Entry* entry) {
  if (archive->loading()) *entry = Entry();
  Distance& distance = entry->distance;
  archive->index(&distance.i, 0, kLastId);
  archive->index(&distance.j, 0, kLastId);
  archive->expect(distance.i < distance.j && distance.j < map_.keyframes.size());
  visit_positive(archive, &distance.metres);
  visit_positive(archive, &distance.sigma);
  archive->index(&entry->submap, -1, kMostCount);
  visit_evidence(archive, &entry->world);
  archive->finite(&entry->weight);
  archive->expect(entry->weight >= 0.0 && entry->weight <= 1.0);
  if (!archive->loading() || !archive->ok() || !is_open(entry->submap)) return;
  const Submap& submap = map_.submaps[entry->submap];
  archive->expect(!submap.is_loop && view_of(submap, distance.i) >= 0 &&
                  view_of(submap, distance.j) >= 0);
}

}  // namespace unisim
