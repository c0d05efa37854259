// SPDX-License-Identifier: MIT
// Metric scale: argument checks and calls into core.
#include <cmath>

#include "capi/src/handle.hpp"
#include "capi/src/read_write.hpp"
#include "capi/src/struct_size.hpp"

using unisim::check_session;
using unisim::core;
using unisim::MetricSource;
using unisim::Status;
using unisim::to_c;

static_assert(UNISIM_METRIC_DISTANCE == static_cast<int>(MetricSource::kDistance) &&
                  UNISIM_METRIC_ODOMETRY == static_cast<int>(MetricSource::kOdometry) &&
                  UNISIM_METRIC_HEIGHT == static_cast<int>(MetricSource::kHeight) &&
                  UNISIM_METRIC_MODEL == static_cast<int>(MetricSource::kModel),
              "numbers of sources");

namespace {

// Beyond these a length is no length of a room or a road, and its logarithm no longer small.
constexpr double kLeastLength = 1e-9;
constexpr double kMostLength = 1e9;
constexpr double kLeastSigma = 1e-6;  // relative

bool is_length(double metres) { return metres >= kLeastLength && metres <= kMostLength; }
bool is_relative(double sigma) { return sigma >= kLeastSigma && sigma <= 1.0; }
bool is_common(double sigma) { return sigma >= 0.0 && sigma <= 1.0; }
bool is_source(int32_t source) { return source >= 0 && source < unisim::kMetricSources; }

}  // namespace

unisim_status unisim_add_distance(unisim_session* session, const unisim_distance* distance) {
  unisim_status status = check_session(session);
  if (status != UNISIM_OK) return status;
  unisim_distance d = {};
  status = unisim::read_struct(distance, &d);
  if (status != UNISIM_OK) return status;
  const double sigma = d.sigma / d.metres;
  const bool good = d.i != d.j && is_source(d.source) && is_length(d.metres) &&
                    is_relative(sigma) && is_common(d.common_sigma);
  if (!good) return UNISIM_ERR_INVALID_ARGUMENT;
  unisim::DistanceInput input;
  input.distance = {d.i < d.j ? d.i : d.j, d.i < d.j ? d.j : d.i, d.metres, sigma};
  input.source = static_cast<MetricSource>(d.source);
  input.common_sigma = d.common_sigma;
  return to_c(core(session)->add_distance(input));
}

unisim_status unisim_add_submap_unit(unisim_session* session, const unisim_submap_unit* unit) {
  unisim_status status = check_session(session);
  if (status != UNISIM_OK) return status;
  unisim_submap_unit u = {};
  status = unisim::read_struct(unit, &u);
  if (status != UNISIM_OK) return status;
  const bool good = is_source(u.source) && is_length(u.metres) && is_relative(u.sigma) &&
                    is_common(u.common_sigma);
  if (!good) return UNISIM_ERR_INVALID_ARGUMENT;
  return to_c(core(session)->add_unit(
      {u.submap_id, u.metres, u.sigma, static_cast<MetricSource>(u.source), u.common_sigma}));
}

unisim_status unisim_get_scale(unisim_session* session, int32_t segment, unisim_scale* scale) {
  unisim_status status = check_session(session);
  if (status == UNISIM_OK) status = unisim::check_output(scale);
  if (status != UNISIM_OK) return status;
  if (segment < 0) return UNISIM_ERR_INVALID_ARGUMENT;
  unisim::ScaleOutput known;
  const Status found = core(session)->scale(segment, &known);
  if (found != Status::kOk) return to_c(found);
  const unisim::DistanceCounts counts = core(session)->distances().counts();
  unisim_scale s = {};
  s.segment = segment;
  s.metres_per_unit = known.metres_per_unit;
  s.sigma = known.sigma;
  s.taken = counts.taken;
  s.refused = counts.refused;
  s.waiting = core(session)->distances().waiting();
  s.lost = counts.lost;
  unisim::write_struct(s, unisim::struct_size_of(scale), scale);
  return UNISIM_OK;
}
