// SPDX-License-Identifier: MIT
// How long a metre is: evidence by node of the graph, and the metre of each segment as a node.
#include "core/map/metric_scale.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/math.hpp"

namespace unisim {
namespace {

// Beyond so many standard deviations a submap's evidence pulls no harder.
constexpr double kHuberWidths = 2.5;
// Of the variance of an information of 1. Residuals do not show a bias that all predictions share:
// from one submap to the next scale is never surer than a third of a per cent. Beyond the other end
// the map has other troubles than its scale.
constexpr double kLeastVariance = 1e-5;
constexpr double kMostVariance = 1e-3;
// Another weight is worth linearising anew.
constexpr double kOtherVariance = 2.0;

// Beyond it lengths leave the range of numbers.
constexpr double kMostLogScale = 40.0;

bool is_sane(const ScaleEvidence& evidence) {
  return std::abs(evidence.log_metres) <= kMostLogScale;
}

}  // namespace

void MetricScale::add(int32_t node, const ScaleEvidence& evidence) {
  if (!is_sane(evidence)) return;
  evidence_[node].kept = fuse(evidence_[node].kept, evidence);
  used_ = true;
}

void MetricScale::set_open(int32_t node, const ScaleEvidence& evidence) {
  evidence_[node].open = is_sane(evidence) ? evidence : ScaleEvidence();
  used_ = used_ || evidence.known();
}

void MetricScale::close(int32_t node) {
  NodeEvidence& here = evidence_[node];
  here.kept = fuse(here.kept, here.open);
  here.open = ScaleEvidence();
}

void MetricScale::rescale(int32_t node, double log_factor) {
  NodeEvidence& here = evidence_[node];
  here.kept = here.kept.of_unit(log_factor);
  here.open = here.open.of_unit(log_factor);
}

void MetricScale::merge(int32_t b, int32_t a, double log_scale, double variance) {
  close(b);
  ScaleEvidence moved = evidence_[b].kept.of_unit(-log_scale);
  if (moved.known()) moved.information = 1.0 / (1.0 / moved.information + variance);
  evidence_[a].kept = fuse(evidence_[a].kept, moved);
  forget(b);
}

void MetricScale::forget(int32_t node) { evidence_[node] = NodeEvidence(); }

ScaleEvidence MetricScale::evidence(int32_t node) const {
  return fuse(evidence_[node].kept, evidence_[node].open);
}

void MetricScale::set_unit_variance(double variance) {
  const double now = std::clamp(variance, kLeastVariance, kMostVariance);
  const double ratio = now / unit_variance_;
  if (ratio > kOtherVariance || ratio < 1.0 / kOtherVariance) unit_variance_ = now;
}

double MetricScale::excess(int32_t metre, const Graph& graph) const {
  double chi2 = 0.0;
  int32_t count = 0;
  for (int32_t node = 0; node < evidence_.size(); ++node) {
    if (evidence_[node].metre != metre) continue;
    chi2 += edge_norm_squared(graph, graph.edge(evidence_[node].edge)) / unit_variance_;
    ++count;
  }
  return count > 1 ? std::max(1.0, chi2 / (count - 1)) : 1.0;
}

int32_t MetricScale::place_of(int32_t segment) const {
  for (int32_t k = 0; k < metres_.size(); ++k) {
    if (metres_[k].segment == segment) return k;
  }
  return -1;
}

int32_t MetricScale::metre(int32_t segment) const {
  const int32_t place = place_of(segment);
  return place < 0 ? -1 : metres_[place].node;
}

Status MetricScale::drop_edge(int32_t node, Graph* graph) {
  NodeEvidence& here = evidence_[node];
  const int32_t edge = here.edge;
  here.edge = -1;
  here.metre = -1;
  return edge < 0 ? Status::kOk : graph->remove_edge(edge);
}

Status MetricScale::drop_metre(int32_t place, Graph* graph) {
  const int32_t metre = metres_[place].node;
  for (int32_t node = 0; node < evidence_.size(); ++node) {
    if (evidence_[node].metre != metre) continue;
    const Status status = drop_edge(node, graph);
    if (!is_ok(status)) return status;
  }
  for (int32_t k = place; k + 1 < metres_.size(); ++k) metres_[k] = metres_[k + 1];
  metres_.pop_back();
  return graph->remove_node(metre);
}

/// @param log_units log of the world's units in a metre, where the segment has no metre yet
/// @param[out] node -1: there are as many as there may be, all of later segments
Status MetricScale::give_metre(int32_t segment, double log_units, Graph* graph, int32_t* node) {
  *node = metre(segment);
  if (*node >= 0) return Status::kOk;
  if (metres_.full()) {
    int32_t oldest = 0;
    for (int32_t k = 1; k < metres_.size(); ++k) {
      if (metres_[k].segment < metres_[oldest].segment) oldest = k;
    }
    if (segment < metres_[oldest].segment) return Status::kOk;
    const Status status = drop_metre(oldest, graph);
    if (!is_ok(status)) return status;
  }
  const Status status =
      graph->add_node(NodeKind::kMetre, Sim3::scaling(math::exp(log_units)), node);
  if (is_ok(status) && !metres_.push_back({segment, *node, -1.0})) return Status::kInternal;
  return status;
}

Status MetricScale::release(int32_t segment, Graph* graph) {
  const int32_t place = place_of(segment);
  return place < 0 ? Status::kOk : drop_metre(place, graph);
}

Status MetricScale::drop_unused(Graph* graph) {
  for (int32_t place = metres_.size() - 1; place >= 0; --place) {
    bool used = false;
    for (const NodeEvidence& here : evidence_) used = used || here.metre == metres_[place].node;
    const Status status = used ? Status::kOk : drop_metre(place, graph);
    if (!is_ok(status)) return status;
  }
  return Status::kOk;
}

Status MetricScale::show(int32_t node, int32_t segment, Graph* graph) {
  NodeEvidence& here = evidence_[node];
  const ScaleEvidence now = evidence(node);
  const double log_units = math::log(graph->pose(node).s) - now.log_metres;
  if (!now.known() || !(std::abs(log_units) <= kMostLogScale)) return drop_edge(node, graph);
  int32_t metre = -1;
  Status status = give_metre(segment, log_units, graph, &metre);
  if (!is_ok(status)) return status;
  if (metre < 0) return drop_edge(node, graph);
  if (here.edge >= 0 && (here.metre != metre || here.shown_variance != unit_variance_)) {
    status = drop_edge(node, graph);
    if (!is_ok(status)) return status;
  }
  EdgeWeight weight;
  weight.multiplier = now.information * unit_variance_;
  if (here.edge < 0) {
    weight.kernel = {RobustKernelKind::kHuber, kHuberWidths * std::sqrt(unit_variance_)};
    status = graph->add_metric(metre, node, now.log_metres, weight, &here.edge);
    here.metre = metre;
    here.shown_variance = unit_variance_;
  } else if (graph->edge(here.edge).log_ratio != now.log_metres ||
             graph->edge(here.edge).multiplier != weight.multiplier) {
    status = graph->set_log_ratio(here.edge, now.log_metres);
    if (is_ok(status)) status = graph->set_multiplier(here.edge, weight.multiplier);
  }
  return status;
}

}  // namespace unisim
