/* SPDX-License-Identifier: MIT */
/* A noisy walk with loops through a session; prints a hash of every bit that comes out. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unisim/unisim.h>

enum { kKeyframes = 72, kWindow = 8, kColumns = 12, kRows = 9, kPixels = kColumns * kRows };

static uint64_t random_state = 1;
static uint64_t hash = 14695981039346656037ULL;

/* -1 .. 1; integers and one exact division: the same numbers everywhere. */
static double noise(void) {
  random_state = random_state * 6364136223846793005ULL + 1442695040888963407ULL;
  return (double)(int64_t)(random_state >> 33) / 1073741824.0 - 1.0;
}

static void add_to_hash(const void* bytes, size_t size) {
  const unsigned char* byte = bytes;
  for (size_t i = 0; i < size; ++i) hash = (hash ^ byte[i]) * 1099511628211ULL;
}

static void expect(int condition, const char* what) {
  if (condition) return;
  fprintf(stderr, "probe: %s failed\n", what);
  exit(1);
}

/* Keyframe j seen from keyframe i: forward 0.3 each, a slight turn, noise; lengths in `unit`. */
static unisim_sim3 seen_from(int i, int j, double unit) {
  unisim_sim3 T = {{0.0, 0.01 * (j - i), 0.0, 1.0}, {0.0, 0.0, 0.3 * (j - i)}, 1.0};
  for (int k = 0; k < 3; ++k) T.q[k] += 0.002 * noise(); /* initialisers have no order in C */
  for (int k = 0; k < 3; ++k) T.t[k] += 0.01 * noise();
  const double length = sqrt(T.q[0] * T.q[0] + T.q[1] * T.q[1] + T.q[2] * T.q[2] + 1.0);
  for (int k = 0; k < 4; ++k) T.q[k] /= length;
  for (int k = 0; k < 3; ++k) T.t[k] /= unit;
  return T;
}

static unisim_depth_map depth_in(double unit, float* pixels) {
  for (int k = 0; k < kPixels; ++k) {
    pixels[k] = (float)((2.0 + 0.1 * (k % 7) + 0.02 * noise()) / unit);
  }
  const unisim_depth_map map = {pixels, NULL, kColumns, kRows};
  return map;
}

static void answer_pairs(unisim_session* session) {
  static float pixels[2][kPixels];
  unisim_request want = {.struct_size = sizeof want};
  while (unisim_next_request(session, UNISIM_REQUEST_PAIR, &want) == UNISIM_OK) {
    const double unit = 1.0 + 0.3 * noise();
    const int i = want.keyframe_ids[0], j = want.keyframe_ids[1];
    unisim_two_view pair = {.struct_size = sizeof pair, .i = i, .j = j};
    pair.T_i_j = seen_from(i, j, unit);
    pair.depth_i = depth_in(unit, pixels[0]);
    pair.depth_j = depth_in(unit, pixels[1]);
    expect(unisim_add_two_view(session, &pair) == UNISIM_OK, "unisim_add_two_view");
  }
}

static unisim_submap submap_of(const int32_t* ids, int count) {
  static float pixels[UNISIM_MAX_VIEWS][kPixels];
  static unisim_sim3 poses[UNISIM_MAX_VIEWS];
  static unisim_depth_map maps[UNISIM_MAX_VIEWS];
  const double unit = 1.0 + 0.3 * noise();
  for (int k = 0; k < count; ++k) {
    poses[k] = seen_from(ids[0], ids[k], unit);
    maps[k] = depth_in(unit, pixels[k]);
  }
  const unisim_submap submap = {sizeof submap, count, ids, poses, maps, 0.0};
  return submap;
}

static void answer_windows(unisim_session* session) {
  unisim_request want = {.struct_size = sizeof want};
  while (unisim_next_request(session, UNISIM_REQUEST_WINDOW, &want) == UNISIM_OK) {
    const unisim_submap submap = submap_of(want.keyframe_ids, want.count);
    int32_t id = -1;
    expect(unisim_add_submap(session, &submap, &id) == UNISIM_OK, "unisim_add_submap");
    expect(unisim_optimize(session, NULL, NULL) == UNISIM_OK, "unisim_optimize");
  }
}

static void close_loop(unisim_session* session, int32_t newest) {
  const int32_t ids[4] = {0, 1, newest - 1, newest};
  const unisim_submap loop = submap_of(ids, 4);
  int32_t id = -1;
  expect(unisim_add_loop(session, &loop, &id) == UNISIM_OK, "unisim_add_loop");
  expect(unisim_optimize(session, NULL, NULL) == UNISIM_OK, "unisim_optimize after a loop");
}

/* Half a metre for each length of 1. */
static void say_distance(unisim_session* session, int32_t i, int32_t j) {
  unisim_distance distance = {.struct_size = sizeof distance, .i = i, .j = j};
  distance.source = UNISIM_METRIC_ODOMETRY;
  distance.metres = 0.5 * 0.3 * (j - i) * (1.0 + 0.02 * noise());
  distance.sigma = 0.02 * distance.metres;
  expect(unisim_add_distance(session, &distance) == UNISIM_OK, "unisim_add_distance");
}

static void add_scale_to_hash(unisim_session* session) {
  unisim_scale scale = {.struct_size = sizeof scale};
  expect(unisim_get_scale(session, 0, &scale) == UNISIM_OK, "unisim_get_scale");
  add_to_hash(&scale, sizeof scale);
}

static void add_poses_to_hash(unisim_session* session) {
  for (int32_t id = 0; id < kKeyframes; ++id) {
    unisim_pose pose = {.struct_size = sizeof pose};
    expect(unisim_get_pose(session, id, &pose) == UNISIM_OK, "unisim_get_pose");
    add_to_hash(&pose.T_world_kf, sizeof pose.T_world_kf);
  }
}

/* A snapshot in memory; its bytes are hashed. */
static struct {
  unsigned char bytes[400000];
  size_t size;
  size_t read;
} saved;

static int32_t write_saved(void* context, const void* bytes, size_t size) {
  (void)context;
  if (sizeof saved.bytes - saved.size < size) return 0;
  memcpy(saved.bytes + saved.size, bytes, size);
  saved.size += size;
  add_to_hash(bytes, size);
  return 1;
}

static int32_t read_saved(void* context, void* bytes, size_t size) {
  (void)context;
  if (saved.size - saved.read < size) return 0;
  memcpy(bytes, saved.bytes + saved.read, size);
  saved.read += size;
  return 1;
}

static void interrupt(unisim_session* session) {
  saved.size = saved.read = 0;
  expect(unisim_save_map(session, write_saved, NULL) == UNISIM_OK, "unisim_save_map");
  expect(unisim_session_reset(session) == UNISIM_OK, "unisim_session_reset");
  expect(unisim_load_map(session, read_saved, NULL) == UNISIM_OK, "unisim_load_map");
}

static void walk(int window_submaps) {
  unisim_config config;
  expect(unisim_config_init(&config, sizeof config) == UNISIM_OK, "unisim_config_init");
  config.max_keyframes = kKeyframes;
  config.window_size = kWindow;
  config.window_submaps = window_submaps;
  config.scatter_gate = 0.2;
  config.depth_grid_width = kColumns;
  config.depth_grid_height = kRows;
  size_t size = 0;
  expect(unisim_arena_size(&config, &size) == UNISIM_OK, "unisim_arena_size");
  void* arena = malloc(size);
  unisim_session* session = NULL;
  expect(unisim_session_create(&session, &config, arena, size) == UNISIM_OK, "create");
  for (int32_t k = 0; k < kKeyframes; ++k) {
    const unisim_keyframe keyframe = {sizeof keyframe, 0, k * INT64_C(100000000)};
    int32_t id = 0;
    expect(unisim_add_keyframe(session, &keyframe, &id) == UNISIM_OK, "unisim_add_keyframe");
    answer_pairs(session);
    answer_windows(session);
    if (k > 0 && k % 4 == 0) say_distance(session, k - 4, k);
    if (k == kKeyframes / 2) close_loop(session, k);
    if (k == kKeyframes / 2 + 5) interrupt(session);
  }
  add_poses_to_hash(session);
  add_scale_to_hash(session);
  double covariance[49];
  if (unisim_get_covariance(session, kKeyframes - 1, covariance) == UNISIM_OK) {
    add_to_hash(covariance, sizeof covariance);
  }
  unisim_session_info info = {.struct_size = sizeof info};
  expect(unisim_get_info(session, &info) == UNISIM_OK, "unisim_get_info");
  expect(info.submaps > 3 && info.submaps_refused == 0, "the walk makes no map");
  unisim_session_destroy(session);
  free(arena);
}

/* Over 100 GB: a machine of 32 bits says so instead of counting wrong. */
static void ask_for_too_much(void) {
  unisim_config config;
  expect(unisim_config_init(&config, sizeof config) == UNISIM_OK, "unisim_config_init");
  config.max_keyframes = 65536;
  config.window_size = UNISIM_MAX_VIEWS;
  config.window_overlap = UNISIM_MAX_VIEWS - 1;
  config.max_loops = 4096;
  size_t size = 0;
  const unisim_status status = unisim_arena_size(&config, &size);
  if (sizeof size == 4) {
    expect(status == UNISIM_ERR_OUT_OF_MEMORY, "too large a session");
  } else {
    expect(status == UNISIM_OK && size / 1000000000 > 100, "a large session");
  }
}

int main(void) {
  ask_for_too_much();
  walk(0);
  walk(2);
  printf("%016llx\n", (unsigned long long)hash);
  return 0;
}
