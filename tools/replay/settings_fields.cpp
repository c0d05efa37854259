// SPDX-License-Identifier: MIT
// What a configuration file may set. Ranges are those stated at the fields' declarations; one that
// depends on another field is the widest here, check_together() or the driver knows the rest.
#include "tools/replay/settings_fields.hpp"

namespace unisim::replay {
namespace {

using tools::Range;

// "Any positive number" with an end: products of a few of them are finite.
constexpr double kLarge = 1e12;

void add_session_fields(unisim_config* c, std::vector<Field>* fields) {
  const char* s = "session";
  fields->insert(
      fields->end(),
      {{s, "preset", &c->preset, Range::whole(UNISIM_PRESET_CONSISTENT, UNISIM_PRESET_PAPER)},
       {s, "window_size", &c->window_size, Range::whole(2, UNISIM_MAX_VIEWS)},
       {s, "window_overlap", &c->window_overlap, Range::whole(0, UNISIM_MAX_VIEWS - 1)},
       {s, "max_keyframes", &c->max_keyframes, Range::whole(2, 65536)},
       {s, "max_submaps", &c->max_submaps, Range::whole(0, 65536)},
       {s, "max_loops", &c->max_loops, Range::whole(0, 4096)},
       {s, "depth_grid_width", &c->depth_grid_width, Range::whole(4, 512)},
       {s, "depth_grid_height", &c->depth_grid_height, Range::whole(4, 512)},
       {s, "disabled_factors", &c->disabled_factors, Range::whole(0, 31)},
       {s, "weight_two_view", &c->weight_two_view, Range::number(0.0, kLarge)},
       {s, "weight_bridge", &c->weight_bridge, Range::number(0.0, kLarge)},
       {s, "weight_scale_anchor", &c->weight_scale_anchor, Range::number(0.0, kLarge)},
       {s, "weight_tie", &c->weight_tie, Range::number(0.0, kLarge)},
       {s, "weight_scale", &c->weight_scale, Range::number(0.0, kLarge)},
       {s, "huber_delta", &c->huber_delta, Range::above(0.0, kLarge)},
       {s, "loop_delta", &c->loop_delta, Range::above(0.0, kLarge)},
       {s, "live_scale_exponent", &c->live_scale_exponent, Range::number(0.0, 1.0)},
       {s, "confidence_drop", &c->confidence_drop, Range::number(0.0, 0.9)},
       {s, "sigma_reference", &c->sigma_reference, Range::above(0.0, kLarge)},
       {s, "sigma_gate", &c->sigma_gate, Range::above(0.0, kLarge)},
       {s, "sigma_gate_loop", &c->sigma_gate_loop, Range::above(0.0, kLarge)},
       {s, "scatter_gate", &c->scatter_gate, Range::above(0.0, kLarge)},
       {s, "loop_gate", &c->loop_gate, Range::number(0.0, kLarge)},
       {s, "sigma_factor", &c->sigma_factor, Range::number(0.0, kLarge)},
       {s, "window_submaps", &c->window_submaps, Range::whole(2, 64).or_zero()},
       {s, "skeleton_capacity", &c->skeleton_capacity, Range::whole(8, 65536).or_zero()},
       {s, "lost_after", &c->lost_after, Range::whole(1, 1000000)},
       {s, "max_iterations", &c->max_iterations, Range::whole(1, 1000000)}});
}

void add_pipeline_fields(pipeline::Options* o, std::vector<Field>* fields) {
  const char* s = "pipeline";
  fields->insert(fields->end(),
                 {{s, "stride", &o->keyframes.stride, Range::whole(0, kMostStride)},
                  {s, "flow", &o->keyframes.flow, Range::number(0.0, 100.0)},
                  {s, "tracked", &o->keyframes.tracked, Range::number(0.0, 1.0)},
                  {s, "min_gap", &o->keyframes.min_gap, Range::whole(1, kMostStride)},
                  {s, "max_gap", &o->keyframes.max_gap, Range::whole(1, kMostStride)},
                  {s, "queue_frames", &o->queue_frames, Range::whole(1, 256)},
                  {s, "patience_s", &o->patience_s, Range::number(0.0, 86400.0)},
                  {s, "every_frame", &o->every_frame, Range::whole(0, 1)},
                  {s, "realtime", &o->realtime, Range::whole(0, 1)}});
}

void add_loop_fields(pipeline::LoopConfig* c, std::vector<Field>* fields) {
  const char* s = "loops";
  fields->insert(fields->end(), {{s, "places", &c->places, Range::whole(0, 65536)},
                                 {s, "gap", &c->gap, Range::whole(10, 100000)},
                                 {s, "tries", &c->tries, Range::whole(1, 50)},
                                 {s, "likeness", &c->likeness, Range::number(0.0, 1.0)}});
}

void add_geometric_fields(unisim_geometric_config* c, std::vector<Field>* fields) {
  const char* s = "geometric";
  fields->insert(
      fields->end(),
      {{s, "max_tracks", &c->max_tracks, Range::whole(50, 2000)},
       {s, "max_keyframes", &c->max_keyframes, Range::whole(32, 4096)},
       {s, "max_landmarks", &c->max_landmarks, Range::whole(200, 1000000)},
       {s, "max_window_views", &c->max_window_views, Range::whole(UNISIM_MAX_VIEWS, 65536)},
       {s, "window_size", &c->window_size, Range::whole(5, UNISIM_MAX_VIEWS)},
       {s, "adjust_every", &c->adjust_every, Range::whole(0, 100000)},
       {s, "adjust_latency", &c->adjust_latency, Range::whole(1, 1000)},
       {s, "background", &c->background, Range::whole(0, 1)},
       {s, "revive_age", &c->revive_age, Range::whole(0, 1000000)},
       {s, "revive_tries", &c->revive_tries, Range::whole(0, 2000)},
       {s, "focal_px", &c->focal_px, Range::number(0.0, kMostFocalPx)},
       {s, "focal_y_px", &c->focal_y_px, Range::number(0.0, kMostFocalPx)},
       {s, "principal_x_px", &c->principal_x_px, Range::number(0.0, kMostFocalPx)},
       {s, "principal_y_px", &c->principal_y_px, Range::number(0.0, kMostFocalPx)},
       {s, "distortion_model", &c->distortion_model,
        Range::whole(UNISIM_DISTORTION_UNKNOWN, UNISIM_DISTORTION_FISHEYE)},
       {s, "calibrated_width", &c->calibrated_width, Range::whole(0, 100000)},
       {s, "calibrated_height", &c->calibrated_height, Range::whole(0, 100000)},
       {s, "shutter", &c->shutter, Range::whole(UNISIM_SHUTTER_GLOBAL, UNISIM_SHUTTER_ROLLING)},
       {s, "readout_ms", &c->readout_ms, Range::number(-kMostReadoutMs, kMostReadoutMs)},
       {s, "places", &c->places, Range::whole(0, 1)},
       {s, "loop_gap", &c->loop_gap, Range::whole(6, 100000)},
       {s, "loop_tries", &c->loop_tries, Range::whole(0, 50)},
       {s, "min_pnp", &c->min_pnp, Range::whole(6, 1000)},
       {s, "min_inliers", &c->min_inliers, Range::whole(6, 1000)},
       {s, "min_share", &c->min_share, Range::number(0.0, 1.0)}});
  for (int i = 0; i < UNISIM_DISTORTION_TERMS; ++i) {
    fields->push_back({s, "distortion_" + std::to_string(i + 1), &c->distortion[i],
                       Range::number(-kMostDistortion, kMostDistortion)});
  }
}

void add_onnx_fields(unisim_onnx_config* c, std::vector<Field>* fields) {
  const char* s = "onnx";
  fields->insert(fields->end(),
                 {{s, "threads", &c->threads, Range::whole(0, kMostThreads)},
                  {s, "memory_mb", &c->memory_mb, Range::whole(0, kMostMemoryMb)},
                  {s, "keyframe_interval", &c->keyframe_interval, Range::whole(1, 1000)},
                  {s, "min_pose_confidence", &c->min_pose_confidence, Range::number(0.0, 1.0)}});
}

}  // namespace

std::vector<Field> all_fields(Settings* settings) {
  std::vector<Field> fields;
  add_session_fields(&settings->session, &fields);
  add_pipeline_fields(&settings->pipeline, &fields);
  add_loop_fields(&settings->pipeline.loops, &fields);
  add_geometric_fields(&settings->geometric, &fields);
  add_onnx_fields(&settings->onnx, &fields);
  return fields;
}

}  // namespace unisim::replay
