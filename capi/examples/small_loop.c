/* SPDX-License-Identifier: MIT */
/* A camera walks once around a square room; made-up predictions stand in for a network. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unisim/unisim.h>

#define CHECK(call) \
  if ((call) != UNISIM_OK) exit(fprintf(stderr, "%s failed\n", #call) < 0 ? 2 : 1)
enum { kKeyframes = 32, kPixels = 64 };

/* One step: forward 0.3 and, at each corner, a turn of 90 degrees to the right. */
static unisim_sim3 step_after(int keyframe) {
  const double half_turn = keyframe % 8 == 7 ? 0.25 * 3.14159265358979 : 0.0;
  const unisim_sim3 step = {{0.0, sin(half_turn), 0.0, cos(half_turn)}, {0.0, 0.0, 0.3}, 1.0};
  return step;
}

int main(void) {
  unisim_config config;
  CHECK(unisim_config_init(&config, sizeof config));
  config.max_keyframes = kKeyframes;
  size_t size = 0;
  CHECK(unisim_arena_size(&config, &size));
  void* arena = malloc(size); /* or a static array: nothing is asked of the system from here on */
  unisim_session* session = NULL;
  CHECK(unisim_session_create(&session, &config, arena, size));

  float depth[kPixels];
  for (int k = 0; k < kPixels; ++k) depth[k] = 2.0F + 0.1F * (float)(k % 8);
  const unisim_depth_map map = {depth, NULL, 8, kPixels / 8};
  for (int k = 0; k < kKeyframes; ++k) {
    const unisim_keyframe keyframe = {sizeof keyframe, 0, k * INT64_C(100000000)};
    int32_t id = 0;
    CHECK(unisim_add_keyframe(session, &keyframe, &id));
    unisim_request want = {.struct_size = sizeof want};
    if (unisim_next_request(session, UNISIM_REQUEST_PAIR, &want) != UNISIM_OK) continue;
    const int i = want.keyframe_ids[0], j = want.keyframe_ids[1];
    const unisim_two_view pair = {.struct_size = sizeof pair,
                                  .i = i,
                                  .j = j,
                                  .T_i_j = step_after(i),
                                  .depth_i = map,
                                  .depth_j = map};
    CHECK(unisim_add_two_view(session, &pair));
    unisim_pose live = {.struct_size = sizeof live};
    CHECK(unisim_get_pose(session, j, &live));
    printf("%2d  %6.2f %6.2f %6.2f\n", j, live.T_world_kf.t[0], live.T_world_kf.t[1],
           live.T_world_kf.t[2]);
  }
  CHECK(unisim_optimize(session, NULL, NULL));
  unisim_session_destroy(session);
  free(arena);
  return 0;
}
