// SPDX-License-Identifier: MIT
// Condensed loops: a bounded number of chain edges.
#include "core/skeleton/loop_edges.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/graph/chain_transfer.hpp"

namespace unisim {
namespace {

// Square of the whitened difference below which two loops between the same nodes say the same: one
// standard deviation over all seven numbers together.
constexpr double kLargestDisagreement = 1.0;

}  // namespace

int32_t replace_chain(Map& map, int32_t id, int32_t a, int32_t b, const ChainLink& link) {
  const Edge edge = map.graph.edge(id);
  int32_t made = -1;
  map.holds(map.graph.remove_edge(id));
  if (!map.holds(map.graph.add_chain(a, b, link, edge.given_weight(), &made))) return id;
  map.holds(map.graph.set_suspended(made, edge.suspended));
  return made;
}

int32_t LoopEdges::slot_of(int32_t edge) const {
  for (int32_t slot = 0; slot < edges_.size(); ++slot) {
    if (edges_[slot].edge == edge) return slot;
  }
  return -1;
}

bool LoopEdges::join(int32_t a, int32_t b, const ChainLink& link, Submap* loop) {
  const int32_t same = loop->health.suspended ? -1 : fusible(a, b, link, -1);
  if (same < 0) return false;
  fuse(same, link);
  ++edges_[same].loops;
  edges_[same].loop = loop->id;
  loop->loop_edge = same;
  return true;
}

void LoopEdges::add(int32_t a, int32_t b, const ChainLink& link, Submap* loop) {
  int32_t slot = slot_of(-1);
  if (slot < 0) {
    slot = edges_.size();
    edges_.resize(slot + 1);
    edges_[slot] = LoopEdge();
  }
  LoopEdge made;
  const EdgeWeight weight = {1.0, 1.0, map_.config.kernel(EdgeOrigin::kLoop), EdgeOrigin::kLoop};
  if (!map_.holds(map_.graph.add_chain(a, b, link, weight, &made.edge))) return;
  map_.holds(map_.graph.set_suspended(made.edge, loop->health.suspended));
  watch_.take(loop->health);
  made.loop = loop->id;
  made.loops = 1;
  made.health = loop->health;
  edges_[slot] = made;
  loop->loop_edge = slot;
}

/// Slot of an edge between the same nodes, other than `but`, that says the same. -1: none
int32_t LoopEdges::fusible(int32_t a, int32_t b, const ChainLink& link, int32_t but) const {
  for (int32_t slot = 0; slot < edges_.size(); ++slot) {
    const LoopEdge& other = edges_[slot];
    if (slot == but || other.edge < 0 || other.health.suspended) continue;
    const Edge& edge = map_.graph.edge(other.edge);
    if (edge.a != a || edge.b != b) continue;
    if (disagreement_squared(link, map_.graph.link(edge)) <= kLargestDisagreement) return slot;
  }
  return -1;
}

void LoopEdges::fuse(int32_t slot, const ChainLink& link) {
  const Edge edge = map_.graph.edge(edges_[slot].edge);
  const ChainLink fused = unisim::fuse(map_.graph.link(edge), link);
  // Informations at the end of the range of numbers do not survive a sum.
  if (!valid_link(fused)) return;
  edges_[slot].edge = replace_chain(map_, edges_[slot].edge, edge.a, edge.b, fused);
}

/// Loops that do not agree stay rivals.
void LoopEdges::fuse_at(int32_t node) {
  for (int32_t slot = 0; slot < edges_.size(); ++slot) {
    const LoopEdge one = edges_[slot];
    if (one.edge < 0 || one.health.suspended) continue;
    const Edge edge = map_.graph.edge(one.edge);
    if (edge.a != node && edge.b != node) continue;
    const ChainLink link = map_.graph.link(edge);
    const int32_t other = fusible(edge.a, edge.b, link, slot);
    if (other < 0) continue;
    fuse(other, link);
    edges_[other].loops += one.loops;
    edges_[other].loop = std::max(edges_[other].loop, one.loop);
    map_.holds(map_.graph.remove_edge(one.edge));
    release(slot, other);
  }
}

void LoopEdges::release(int32_t slot, int32_t into) {
  watch_.leave(edges_[slot].health);
  edges_[slot] = LoopEdge();
  for (int32_t k = 0; k < map_.submaps.size(); ++k) {
    if (map_.submaps.at(k).loop_edge == slot) map_.submaps.at(k).loop_edge = into;
  }
}

int32_t LoopEdges::remove(int32_t slot) {
  const LoopEdge gone = edges_[slot];
  for (int32_t k = 0; k < map_.submaps.size(); ++k) {
    if (map_.submaps.at(k).loop_edge == slot) map_.submaps.at(k).removed = true;
  }
  map_.holds(map_.graph.remove_edge(gone.edge));
  release(slot, -1);
  return gone.loops;
}

void LoopEdges::drop(int32_t slot) {
  LogLine line;
  line << "loop " << edges_[slot].loop
       << " dropped: loop edges at their limit, another says much the same";
  line.send(map_.config.log, LogLevel::kInfo);
  dropped_loops_ += remove(slot);
}

void LoopEdges::drop_at(int32_t node) {
  for (int32_t slot = 0; slot < edges_.size(); ++slot) {
    const int32_t id = edges_[slot].edge;
    if (id < 0) continue;
    const Edge& edge = map_.graph.edge(id);
    if (edge.a == node || edge.b == node) drop(slot);
  }
}

/// Measured: moving the ends of that edge to those of the other and fusing the two is no better.
int32_t LoopEdges::weakest(Span<const int32_t> order) {
  for (LoopEdge& loop : edges_) {
    if (loop.edge < 0) continue;
    loop.order_a = order[map_.graph.edge(loop.edge).a];
    loop.order_b = order[map_.graph.edge(loop.edge).b];
  }
  const auto information = [&](int32_t slot) {
    return map_.graph.link(map_.graph.edge(edges_[slot].edge)).Lambda.trace();
  };
  int32_t weakest = -1;
  int32_t nearest = std::numeric_limits<int32_t>::max();
  for (int32_t one = 0; one < edges_.size(); ++one) {
    if (edges_[one].edge < 0) continue;
    if (edges_[one].health.suspended) return one;
    if (weakest < 0) weakest = one;
    const LoopEdge& loop = edges_[one];
    for (int32_t other = one + 1; nearest > 0 && other < edges_.size(); ++other) {
      const LoopEdge& rival = edges_[other];
      const int32_t apart =
          std::abs(loop.order_a - rival.order_a) + std::abs(loop.order_b - rival.order_b);
      if (apart >= nearest || rival.edge < 0) continue;
      nearest = apart;
      weakest = information(one) > information(other) ? other : one;
    }
  }
  return weakest;
}

void LoopEdges::visit(Archive* archive) {
  const int32_t next_submap = map_.submaps.next_id();
  archive->index(&dropped_loops_, 0, next_submap);
  int32_t count = edges_.size();
  archive->index(&count, 0, next_submap);
  archive->need("skeleton_capacity", count, edges_.capacity());
  if (!archive->ok()) return;
  if (archive->loading()) edges_.resize(count);
  int64_t loops = dropped_loops_;
  for (int32_t slot = 0; archive->ok() && slot < count; ++slot) {
    LoopEdge& loop = edges_[slot];
    if (archive->loading()) loop = LoopEdge();
    bool in_use = loop.edge >= 0;
    archive->flag(&in_use);
    if (!in_use) continue;
    archive->index(&loop.loop, 0, next_submap - 1);
    archive->index(&loop.loops, 1, next_submap);
    visit_health(archive, &loop.health);
    loops += loop.loops;
    if (!archive->loading()) continue;
    loop.edge = 0;  // visit_edges() says which
    watch_.take(loop.health);
  }
  archive->expect(loops <= next_submap);
}

void LoopEdges::visit_edges(Archive* archive) {
  for (LoopEdge& loop : edges_) {
    if (loop.edge < 0) continue;
    map_.graph.visit_edge(archive, FactorKind::kChain, &loop.edge);
    archive->expect(loop.edge >= 0);
    if (!archive->ok()) return;
    archive->expect(map_.graph.edge(loop.edge).origin == EdgeOrigin::kLoop);
  }
}

}  // namespace unisim
