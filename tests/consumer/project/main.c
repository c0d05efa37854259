/* SPDX-License-Identifier: MIT */
/* What a user would write first: exit code 0 when all went well. */
#include <stdlib.h>
#include <unisim/unisim.h>

int main(void) {
  unisim_config config;
  unisim_session* session = NULL;
  unisim_keyframe keyframe = {sizeof keyframe, 0, 1};
  size_t size = 0;
  int32_t id = -1;
  void* arena = NULL;
  if (unisim_config_init(&config, sizeof config) != UNISIM_OK) return 1;
  if (unisim_arena_size(&config, &size) != UNISIM_OK) return 2;
  arena = malloc(size);
  if (unisim_session_create(&session, &config, arena, size) != UNISIM_OK) return 3;
  if (unisim_add_keyframe(session, &keyframe, &id) != UNISIM_OK || id != 0) return 4;
  unisim_session_destroy(session);
  free(arena);
  return unisim_version() == UNISIM_VERSION_NUMBER ? 0 : 5;
}
