// SPDX-License-Identifier: MIT
// How long a metre is: measurements in, the scale of a segment out.
#include <algorithm>
#include <cmath>

#include "core/base/math.hpp"
#include "core/session.hpp"

namespace unisim {

void MetricSources::add(MetricSource source, double sigma, double common) {
  const auto k = static_cast<int32_t>(source);
  information[k] += 1.0 / (sigma * sigma);
  common_sigma[k] = std::max(common_sigma[k], common);
}

double MetricSources::common_variance() const {
  double sum = 0.0;
  for (const double one : information) sum += one;
  double variance = 0.0;
  for (int32_t k = 0; k < kMetricSources && sum > 0.0; ++k) {
    const double part = information[k] / sum * common_sigma[k];
    variance += part * part;
  }
  return variance;
}

void MetricSources::visit(Archive* archive) {
  for (int32_t k = 0; k < kMetricSources; ++k) {
    archive->finite(&information[k]);
    archive->finite(&common_sigma[k]);
    archive->expect(information[k] >= 0.0 && common_sigma[k] >= 0.0 && common_sigma[k] <= 1.0);
  }
}

Status Session::add_distance(const DistanceInput& input) {
  for (const int32_t id : {input.distance.i, input.distance.j}) {
    if (map_.keyframes.gone(id)) return Status::kRetired;
    if (!map_.keyframes.has(id)) return Status::kInvalidArgument;
  }
  distances_.add(input.distance);
  sources_.add(input.source, input.distance.sigma, input.common_sigma);
  return Status::kOk;
}

Status Session::add_unit(const UnitInput& input) {
  if (map_.submaps.gone(input.submap)) return Status::kRetired;
  if (!map_.submaps.has(input.submap)) return Status::kInvalidArgument;
  const Submap& submap = map_.submaps[input.submap];
  if (submap.is_loop || submap.place.node < 0) return Status::kInvalidArgument;
  const ScaleEvidence unit = {math::log(input.metres), 1.0 / (input.sigma * input.sigma)};
  map_.metric.add(submap.place.node, unit.of_unit(-math::log(submap.place.T_node_submap.s)));
  sources_.add(input.source, input.sigma, input.common_sigma);
  return Status::kOk;
}

/// Before an optimisation: the graph holds what is known of the metre by now.
Status Session::show_metres() {
  if (!distances_.empty()) distances_.settle();
  if (map_.metric.empty()) return Status::kOk;
  for (int32_t k = 0; k < map_.submaps.size(); ++k) {
    const Submap& submap = map_.submaps.at(k);
    if (submap.is_loop || submap.place.node < 0 || !submap.place.own_node) continue;
    const Status status = map_.metric.show(submap.place.node, submap.segment, &map_.graph);
    if (!is_ok(status)) return status;
  }
  return map_.metric.drop_unused(&map_.graph);
}

/// After an optimisation: how sure a metre is.
Status Session::measure_metre(int32_t segment) {
  const int32_t metre = map_.metric.metre(segment);
  Mat7 covariance;
  const Status status = solver_.marginal_covariance(map_.graph, metre, &covariance);
  if (!is_ok(status)) return status;
  const double variance = covariance(6, 6) * map_.metric.unit_variance();
  map_.metric.sigma(segment) = std::sqrt(variance * map_.metric.excess(metre, map_.graph));
  return Status::kOk;
}

/// A metre that comes is known with its standard deviation; without one it stays unknown.
void Session::measure_new_metres() {
  for (int32_t k = 0; k < map_.metric.metres(); ++k) {
    const int32_t segment = map_.metric.segment_of(k);
    if (map_.metric.sigma(segment) < 0.0) static_cast<void>(measure_metre(segment));
  }
}

Status Session::scale(int32_t segment, ScaleOutput* scale) {
  const int32_t metre = map_.metric.metre(segment);
  if (metre < 0) return Status::kNotReady;
  if (map_.graph.revision() == solved_revision_) {
    const Status status = measure_metre(segment);
    if (!is_ok(status)) return status;
  }
  const double sigma = map_.metric.sigma(segment);
  if (sigma < 0.0) return Status::kNotReady;
  scale->metres_per_unit = 1.0 / map_.graph.pose(metre).s;
  const double doubt = distances_.doubt(segment);
  scale->sigma = std::sqrt(sigma * sigma + doubt * doubt + sources_.common_variance());
  return Status::kOk;
}

}  // namespace unisim
