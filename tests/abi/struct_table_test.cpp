// SPDX-License-Identifier: MIT
// Size and offsets of every public struct: fields are never moved, retyped or removed.
#include <cstddef>

#include "tests/support/catch.hpp"
#include "unisim/places.h"
#include "unisim/unisim.h"

// The table holds for LP64; other data models have their own pointers and paddings.
static_assert(sizeof(void*) == 8, "the struct table is that of 64-bit targets");

#define AT(type, field, offset) static_assert(offsetof(type, field) == (offset), #type "." #field)
#define SIZE(type, bytes) static_assert(sizeof(type) == (bytes), #type)

SIZE(unisim_sim3, 64);
AT(unisim_sim3, q, 0);
AT(unisim_sim3, t, 32);
AT(unisim_sim3, s, 56);

SIZE(unisim_depth_map, 24);
AT(unisim_depth_map, depth, 0);
AT(unisim_depth_map, confidence, 8);
AT(unisim_depth_map, width, 16);
AT(unisim_depth_map, height, 20);

SIZE(unisim_config, 192);
AT(unisim_config, struct_size, 0);
AT(unisim_config, preset, 4);
AT(unisim_config, window_size, 8);
AT(unisim_config, window_overlap, 12);
AT(unisim_config, max_keyframes, 16);
AT(unisim_config, max_submaps, 20);
AT(unisim_config, max_loops, 24);
AT(unisim_config, depth_grid_width, 28);
AT(unisim_config, depth_grid_height, 32);
AT(unisim_config, disabled_factors, 36);
AT(unisim_config, weight_two_view, 40);
AT(unisim_config, weight_bridge, 48);
AT(unisim_config, weight_scale_anchor, 56);
AT(unisim_config, weight_tie, 64);
AT(unisim_config, weight_scale, 72);
AT(unisim_config, huber_delta, 80);
AT(unisim_config, loop_delta, 88);
AT(unisim_config, live_scale_exponent, 96);
AT(unisim_config, confidence_drop, 104);
AT(unisim_config, sigma_reference, 112);
AT(unisim_config, sigma_gate, 120);
AT(unisim_config, sigma_gate_loop, 128);
AT(unisim_config, scatter_gate, 136);
AT(unisim_config, lost_after, 144);
AT(unisim_config, max_iterations, 148);
AT(unisim_config, log, 152);
AT(unisim_config, log_user, 160);
AT(unisim_config, window_submaps, 168);
AT(unisim_config, skeleton_capacity, 172);
AT(unisim_config, loop_gate, 176);
AT(unisim_config, sigma_factor, 184);

SIZE(unisim_load_report, 72);
AT(unisim_load_report, struct_size, 0);
AT(unisim_load_report, problem, 4);
AT(unisim_load_report, section, 8);
AT(unisim_load_report, setting, 24);
AT(unisim_load_report, needed, 56);
AT(unisim_load_report, given, 64);

SIZE(unisim_arena_part, 16);
AT(unisim_arena_part, name, 0);
AT(unisim_arena_part, bytes, 8);

SIZE(unisim_keyframe, 16);
AT(unisim_keyframe, struct_size, 0);
AT(unisim_keyframe, reserved, 4);
AT(unisim_keyframe, timestamp_ns, 8);

SIZE(unisim_two_view, 144);
AT(unisim_two_view, struct_size, 0);
AT(unisim_two_view, i, 4);
AT(unisim_two_view, j, 8);
AT(unisim_two_view, reserved, 12);
AT(unisim_two_view, T_i_j, 16);
AT(unisim_two_view, depth_i, 80);
AT(unisim_two_view, depth_j, 104);
AT(unisim_two_view, center_sigma, 128);
AT(unisim_two_view, log_scale_sigma, 136);

SIZE(unisim_submap, 40);
AT(unisim_submap, struct_size, 0);
AT(unisim_submap, count, 4);
AT(unisim_submap, keyframe_ids, 8);
AT(unisim_submap, T_submap_kf, 16);
AT(unisim_submap, depth, 24);
AT(unisim_submap, center_sigma, 32);

SIZE(unisim_submap_update, 40);
AT(unisim_submap_update, struct_size, 0);
AT(unisim_submap_update, submap_id, 4);
AT(unisim_submap_update, count, 8);
AT(unisim_submap_update, scale_settled, 12);
AT(unisim_submap_update, T_submap_kf, 16);
AT(unisim_submap_update, log_depth_ratio, 24);
AT(unisim_submap_update, center_sigma, 32);

SIZE(unisim_request, 268);
AT(unisim_request, struct_size, 0);
AT(unisim_request, kind, 4);
AT(unisim_request, count, 8);
AT(unisim_request, keyframe_ids, 12);

SIZE(unisim_budget, 8);
AT(unisim_budget, struct_size, 0);
AT(unisim_budget, max_iterations, 4);

SIZE(unisim_report, 88);
AT(unisim_report, struct_size, 0);
AT(unisim_report, stop, 4);
AT(unisim_report, iterations, 8);
AT(unisim_report, keyframes, 12);
AT(unisim_report, submaps, 16);
AT(unisim_report, edges, 20);
AT(unisim_report, factor_blocks, 24);
AT(unisim_report, bad_node, 28);
AT(unisim_report, initial_cost, 32);
AT(unisim_report, final_cost, 40);
AT(unisim_report, map_revision, 48);
AT(unisim_report, first_changed, 52);
AT(unisim_report, last_changed, 56);
AT(unisim_report, reserved, 60);
AT(unisim_report, jump_translation, 64);
AT(unisim_report, jump_rotation_rad, 72);
AT(unisim_report, jump_log_scale, 80);

SIZE(unisim_pose, 96);
AT(unisim_pose, struct_size, 0);
AT(unisim_pose, keyframe_id, 4);
AT(unisim_pose, timestamp_ns, 8);
AT(unisim_pose, T_world_kf, 16);
AT(unisim_pose, state, 80);
AT(unisim_pose, confidence, 84);
AT(unisim_pose, submap_id, 88);
AT(unisim_pose, segment, 92);

SIZE(unisim_submap_info, 352);
AT(unisim_submap_info, struct_size, 0);
AT(unisim_submap_info, submap_id, 4);
AT(unisim_submap_info, is_loop, 8);
AT(unisim_submap_info, count, 12);
AT(unisim_submap_info, keyframe_ids, 16);
AT(unisim_submap_info, T_world_submap, 272);
AT(unisim_submap_info, center_sigma, 336);
AT(unisim_submap_info, scatter, 344);

SIZE(unisim_refusal, 32);
AT(unisim_refusal, reason, 0);
AT(unisim_refusal, first_keyframe, 4);
AT(unisim_refusal, last_keyframe, 8);
AT(unisim_refusal, reserved, 12);
AT(unisim_refusal, value, 16);
AT(unisim_refusal, limit, 24);

SIZE(unisim_session_info, 208);
AT(unisim_session_info, struct_size, 0);
AT(unisim_session_info, state, 4);
AT(unisim_session_info, keyframes, 8);
AT(unisim_session_info, posed_keyframes, 12);
AT(unisim_session_info, last_posed, 16);
AT(unisim_session_info, submaps, 20);
AT(unisim_session_info, submaps_refused, 24);
AT(unisim_session_info, loops, 28);
AT(unisim_session_info, loops_refused, 32);
AT(unisim_session_info, pairs_refused, 36);
AT(unisim_session_info, segments, 40);
AT(unisim_session_info, lost_events, 44);
AT(unisim_session_info, map_revision, 48);
AT(unisim_session_info, reserved, 52);
AT(unisim_session_info, arena_bytes, 56);
AT(unisim_session_info, arena_peak_bytes, 64);
AT(unisim_session_info, first_keyframe, 72);
AT(unisim_session_info, retired_keyframes, 76);
AT(unisim_session_info, retired_unread, 80);
AT(unisim_session_info, stretches, 84);
AT(unisim_session_info, suspended_loops, 88);
AT(unisim_session_info, loop_suspensions, 92);
AT(unisim_session_info, loop_returns, 96);
AT(unisim_session_info, loops_removed, 100);
AT(unisim_session_info, loops_dropped, 104);
AT(unisim_session_info, reserved_2, 108);
AT(unisim_session_info, refused_pair, 112);
AT(unisim_session_info, refused_window, 144);
AT(unisim_session_info, refused_loop, 176);

SIZE(unisim_retired, 104);
AT(unisim_retired, struct_size, 0);
AT(unisim_retired, kind, 4);
AT(unisim_retired, keyframe_id, 8);
AT(unisim_retired, submap_id, 12);
AT(unisim_retired, anchor_id, 16);
AT(unisim_retired, confidence, 20);
AT(unisim_retired, segment, 24);
AT(unisim_retired, reserved, 28);
AT(unisim_retired, timestamp_ns, 32);
AT(unisim_retired, T, 40);

SIZE(unisim_loop_info, 24);
AT(unisim_loop_info, struct_size, 0);
AT(unisim_loop_info, submap_id, 4);
AT(unisim_loop_info, state, 8);
AT(unisim_loop_info, condensed, 12);
AT(unisim_loop_info, residual, 16);

SIZE(unisim_distance, 40);
AT(unisim_distance, struct_size, 0);
AT(unisim_distance, i, 4);
AT(unisim_distance, j, 8);
AT(unisim_distance, source, 12);
AT(unisim_distance, metres, 16);
AT(unisim_distance, sigma, 24);
AT(unisim_distance, common_sigma, 32);

SIZE(unisim_submap_unit, 40);
AT(unisim_submap_unit, struct_size, 0);
AT(unisim_submap_unit, submap_id, 4);
AT(unisim_submap_unit, source, 8);
AT(unisim_submap_unit, reserved, 12);
AT(unisim_submap_unit, metres, 16);
AT(unisim_submap_unit, sigma, 24);
AT(unisim_submap_unit, common_sigma, 32);

SIZE(unisim_scale, 40);
AT(unisim_scale, struct_size, 0);
AT(unisim_scale, segment, 4);
AT(unisim_scale, metres_per_unit, 8);
AT(unisim_scale, sigma, 16);
AT(unisim_scale, taken, 24);
AT(unisim_scale, refused, 28);
AT(unisim_scale, waiting, 32);
AT(unisim_scale, lost, 36);

SIZE(unisim_places_config, 24);
AT(unisim_places_config, struct_size, 0);
AT(unisim_places_config, capacity, 4);
AT(unisim_places_config, dimension, 8);
AT(unisim_places_config, reserved, 12);
AT(unisim_places_config, same_place, 16);

SIZE(unisim_places_question, 24);
AT(unisim_places_question, struct_size, 0);
AT(unisim_places_question, id, 4);
AT(unisim_places_question, gap, 8);
AT(unisim_places_question, spread, 12);
AT(unisim_places_question, descriptor, 16);

SIZE(unisim_places_match, 8);
AT(unisim_places_match, id, 0);
AT(unisim_places_match, score, 4);

TEST_CASE("numbers of statuses, bits and states never move") {
  CHECK(UNISIM_OK == 0);
  CHECK(UNISIM_ERR_INVALID_ARGUMENT == 1);
  CHECK(UNISIM_ERR_CAPACITY == 2);
  CHECK(UNISIM_ERR_OUT_OF_MEMORY == 3);
  CHECK(UNISIM_ERR_NOT_READY == 4);
  CHECK(UNISIM_ERR_NUMERICAL == 5);
  CHECK(UNISIM_ERR_INTERNAL == 6);
  CHECK(UNISIM_ERR_ABI_MISMATCH == 7);
  CHECK(UNISIM_ERR_RETIRED == 8);
  CHECK(UNISIM_METRIC_DISTANCE == 0);
  CHECK(UNISIM_METRIC_ODOMETRY == 1);
  CHECK(UNISIM_METRIC_HEIGHT == 2);
  CHECK(UNISIM_METRIC_MODEL == 3);
  CHECK(UNISIM_RETIRED_KEYFRAME == 0);
  CHECK(UNISIM_RETIRED_SUBMAP == 1);
  CHECK(UNISIM_LOOP_ACTIVE == 0);
  CHECK(UNISIM_LOOP_SUSPENDED == 1);
  CHECK(UNISIM_LOOP_RIGID == 2);
  CHECK(UNISIM_LOOP_REMOVED == 3);
  CHECK(UNISIM_REFUSED_NONE == 0);
  CHECK(UNISIM_REFUSED_SIGMA == 1);
  CHECK(UNISIM_REFUSED_SCATTER == 2);
  CHECK(UNISIM_REFUSED_VIEWS == 3);
  CHECK(UNISIM_REFUSED_RANGE == 4);
  CHECK(UNISIM_REFUSED_HOST == 5);
  CHECK(UNISIM_REFUSED_ROOM == 6);
  CHECK(UNISIM_REFUSED_LATE == 7);
  CHECK(UNISIM_MAX_VIEWS == 64);
  CHECK(UNISIM_FACTOR_TWO_VIEW == 1U);
  CHECK(UNISIM_FACTOR_BRIDGE == 2U);
  CHECK(UNISIM_FACTOR_SCALE_ANCHOR == 4U);
  CHECK(UNISIM_FACTOR_TIE == 8U);
  CHECK(UNISIM_FACTOR_SCALE == 16U);
  CHECK(UNISIM_REQUEST_PAIR == 1U);
  CHECK(UNISIM_REQUEST_WINDOW == 2U);
  CHECK(UNISIM_REQUEST_LOOP == 4U);
  CHECK(UNISIM_STATE_INIT == 0);
  CHECK(UNISIM_STATE_TRACKING == 1);
  CHECK(UNISIM_STATE_DEGRADED == 2);
  CHECK(UNISIM_STATE_LOST == 3);
  CHECK(UNISIM_STATE_RELOCALISED == 4);
  CHECK(UNISIM_STOP_CONVERGED == 0);
  CHECK(UNISIM_STOP_BUDGET == 1);
  CHECK(UNISIM_STOP_NO_DESCENT == 2);
  CHECK(UNISIM_STOP_NOT_POSITIVE == 3);
}
