// SPDX-License-Identifier: MIT
// Configuration: defaults, ranges, sizes.
#include <cmath>

#include "capi/src/read_write.hpp"
#include "capi/src/struct_size.hpp"

namespace unisim {
namespace {

constexpr double kConsistentWeights[] = {1.0, 1.0, 1.0, 0.2, 1.0};  // by unisim_config order
constexpr double kPaperWeights[] = {1.0, 1.0, 50.0, 0.2, 50.0};

unisim_config defaults() {
  unisim_config config = {};
  config.struct_size = sizeof config;
  config.preset = UNISIM_PRESET_CONSISTENT;
  config.window_size = 16;
  config.window_overlap = 2;
  config.max_keyframes = 1024;
  config.max_loops = 64;
  config.depth_grid_width = 80;
  config.depth_grid_height = 60;
  config.huber_delta = 1.0;
  config.loop_delta = 0.1;
  config.live_scale_exponent = 0.5;
  config.confidence_drop = 0.25;
  config.sigma_reference = 0.001;
  config.sigma_gate = 0.005;
  config.sigma_gate_loop = 0.002;
  config.scatter_gate = 0.13;
  config.lost_after = 3;
  config.max_iterations = 10;
  config.skeleton_capacity = 128;
  config.sigma_factor = 4.0;
  return config;
}

bool within(int32_t value, int32_t least, int32_t most) { return value >= least && value <= most; }
bool positive(double value) { return std::isfinite(value) && value > 0.0; }
bool within(double value, double least, double most) { return value >= least && value <= most; }

bool sizes_in_range(const unisim_config& c) {
  return within(c.preset, UNISIM_PRESET_CONSISTENT, UNISIM_PRESET_PAPER) &&
         within(c.window_size, 2, UNISIM_MAX_VIEWS) &&
         within(c.window_overlap, 0, c.window_size - 1) && within(c.max_keyframes, 2, 65536) &&
         within(c.max_submaps, 0, 65536) && within(c.max_loops, 0, 4096) &&
         within(c.depth_grid_width, 4, 512) && within(c.depth_grid_height, 4, 512) &&
         (c.disabled_factors & ~31U) == 0 && within(c.lost_after, 1, 1000000) &&
         within(c.max_iterations, 1, 1000000) &&
         (c.window_submaps == 0 || within(c.window_submaps, 2, 64)) &&
         (c.skeleton_capacity == 0 || within(c.skeleton_capacity, 8, 65536));
}

bool numbers_in_range(const unisim_config& c) {
  return positive(c.huber_delta) && positive(c.loop_delta) &&
         within(c.live_scale_exponent, 0.0, 1.0) && within(c.confidence_drop, 0.0, 0.9) &&
         positive(c.sigma_reference) && positive(c.sigma_gate) && positive(c.sigma_gate_loop) &&
         positive(c.scatter_gate) && std::isfinite(c.loop_gate) && c.loop_gate >= 0.0 &&
         std::isfinite(c.sigma_factor) && c.sigma_factor >= 0.0;
}

/// Weights by the presets' order; 0 stands for the preset's. false: negative or not finite.
bool read_weights(const unisim_config& from, SessionConfig* to) {
  constexpr FactorKind kKinds[] = {FactorKind::kTwoView, FactorKind::kBridge,
                                   FactorKind::kScaleAnchor, FactorKind::kTie, FactorKind::kScale};
  const double given[] = {from.weight_two_view, from.weight_bridge, from.weight_scale_anchor,
                          from.weight_tie, from.weight_scale};
  const bool paper = from.preset == UNISIM_PRESET_PAPER;
  for (int k = 0; k < kFactorKinds; ++k) {
    if (!std::isfinite(given[k]) || given[k] < 0.0) return false;
    const double preset = paper ? kPaperWeights[k] : kConsistentWeights[k];
    FactorSetting& setting = to->factors[static_cast<int>(kKinds[k])];
    setting.information = given[k] > 0.0 ? given[k] : preset;
    setting.enabled = (from.disabled_factors & (1U << k)) == 0;
  }
  return true;
}

}  // namespace

unisim_status read_config(const unisim_config* from, SessionConfig* to) {
  unisim_config c = defaults();
  const unisim_status status = read_struct(from, &c);
  if (status != UNISIM_OK) return status;
  if (!sizes_in_range(c) || !numbers_in_range(c) || !read_weights(c, to)) {
    return UNISIM_ERR_INVALID_ARGUMENT;
  }
  to->preset = static_cast<Preset>(c.preset);
  to->window_size = c.window_size;
  to->window_overlap = c.window_overlap;
  to->max_keyframes = c.max_keyframes;
  to->max_submaps = c.max_submaps;
  to->max_loops = c.max_loops;
  to->grid = {c.depth_grid_width, c.depth_grid_height};
  to->huber_delta = c.huber_delta;
  to->loop_delta = c.loop_delta;
  // Beyond four widths the robust kernel has let go of a loop.
  constexpr double kGateWidths = 4.0;
  to->loop_gate = c.loop_gate > 0.0 ? c.loop_gate : kGateWidths * c.loop_delta;
  to->live_scale_exponent = c.live_scale_exponent;
  to->confidence_drop = c.confidence_drop;
  to->sigma_reference = c.sigma_reference;
  to->sigma_gate = c.sigma_gate;
  to->sigma_gate_loop = c.sigma_gate_loop;
  to->scatter_gate = c.scatter_gate;
  to->lost_after = c.lost_after;
  to->max_iterations = c.max_iterations;
  to->window_submaps = c.window_submaps;
  to->skeleton_capacity = c.skeleton_capacity;
  to->sigma_factor = c.sigma_factor;
  to->log = {c.log, c.log_user};
  return UNISIM_OK;
}

}  // namespace unisim

using unisim::Arena;
using unisim::SessionConfig;

unisim_status unisim_config_init(unisim_config* config, size_t struct_size) {
  if (config == nullptr) return UNISIM_ERR_INVALID_ARGUMENT;
  if (!unisim::is_size_of<unisim_config>(struct_size)) return UNISIM_ERR_ABI_MISMATCH;
  unisim::write_struct(unisim::defaults(), struct_size, config);
  return UNISIM_OK;
}

unisim_status unisim_arena_size(const unisim_config* config, size_t* size) {
  if (size == nullptr) return UNISIM_ERR_INVALID_ARGUMENT;
  SessionConfig checked;
  const unisim_status status = unisim::read_config(config, &checked);
  if (status != UNISIM_OK) return status;
  const Arena arena = unisim::Session::measure(checked);
  if (!arena.ok()) return UNISIM_ERR_OUT_OF_MEMORY;
  *size = arena.required_bytes();
  return UNISIM_OK;
}

unisim_status unisim_arena_parts(const unisim_config* config, unisim_arena_part* parts,
                                 size_t capacity, size_t* count) {
  if (count == nullptr || (parts == nullptr && capacity > 0)) return UNISIM_ERR_INVALID_ARGUMENT;
  SessionConfig checked;
  const unisim_status status = unisim::read_config(config, &checked);
  if (status != UNISIM_OK) return status;
  const Arena arena = unisim::Session::measure(checked);
  if (!arena.ok()) return UNISIM_ERR_OUT_OF_MEMORY;
  const auto named = static_cast<size_t>(arena.parts().size());
  *count = named + 1;
  if (capacity < *count) return UNISIM_ERR_CAPACITY;
  for (size_t i = 0; i < named; ++i) {
    const unisim::ArenaPart& part = arena.parts()[static_cast<int32_t>(i)];
    parts[i] = {part.name, part.bytes};
  }
  parts[named] = {"alignment slack", arena.required_bytes() - arena.used_bytes()};
  return UNISIM_OK;
}
