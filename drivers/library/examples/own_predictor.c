/* SPDX-License-Identifier: MIT */
/* A predictor of one's own: here it knows that the camera moves a tenth of a unit to the right in
 * front of a wall two units away. Usage: own_predictor SEQUENCE */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unisim/pipeline.h>
#include <unisim/sequence.h>

enum { kWidth = 16, kHeight = 12, kStep = 5 };

struct knowing {
  unisim_predictor table; /* first: the library hands this pointer back */
  float depth[kWidth * kHeight];
  int32_t ids[UNISIM_MAX_VIEWS];
  unisim_sim3 poses[UNISIM_MAX_VIEWS];
  unisim_depth_map maps[UNISIM_MAX_VIEWS];
  int64_t token;
};

/* Camera `steps` keyframes later, seen from the one before. */
static unisim_sim3 moved(int32_t steps) {
  unisim_sim3 T;
  memset(&T, 0, sizeof T);
  T.q[3] = T.s = 1.0;
  T.t[0] = 0.1 * steps;
  return T;
}

static unisim_depth_map wall(struct knowing* me) {
  unisim_depth_map map;
  memset(&map, 0, sizeof map);
  map.depth = me->depth;
  map.width = kWidth;
  map.height = kHeight;
  return map;
}

static int observe(unisim_predictor* predictor, const unisim_frame* frame, unisim_motion* motion) {
  (void)predictor;
  (void)frame;
  motion->flow = motion->tracked = -1.0; /* not measured: the pipeline takes every N-th frame */
  motion->keyframe_advice = 0;
  return UNISIM_PREDICTION_OK;
}

static int keyframe(unisim_predictor* predictor, const unisim_frame* frame, int32_t id) {
  (void)predictor;
  (void)frame;
  (void)id;
  return UNISIM_PREDICTION_OK;
}

static int two_view(unisim_predictor* predictor, int32_t i, int32_t j,
                    unisim_pair_prediction* out) {
  struct knowing* me = (struct knowing*)predictor;
  memset(out, 0, sizeof *out);
  out->T_i_j = moved(j - i);
  out->depth_i = out->depth_j = wall(me);
  return UNISIM_PREDICTION_OK;
}

static int multi_view(unisim_predictor* predictor, const int32_t* ids, int32_t count,
                      unisim_window_prediction* out) {
  struct knowing* me = (struct knowing*)predictor;
  int32_t k;
  for (k = 0; k < count; ++k) {
    me->ids[k] = ids[k];
    me->poses[k] = moved(ids[k] - ids[0]);
    me->maps[k] = wall(me);
  }
  memset(out, 0, sizeof *out);
  out->count = count;
  out->keyframe_ids = me->ids;
  out->T_window_kf = me->poses;
  out->depth = me->maps;
  out->token = me->token++;
  return UNISIM_PREDICTION_OK;
}

static void info(unisim_predictor* predictor, unisim_predictor_info* out) {
  (void)predictor;
  memset(out, 0, sizeof *out);
  out->initialised = 1;
}

static const char* message_of(unisim_predictor* predictor) {
  (void)predictor;
  return "";
}

static void destroy(unisim_predictor* predictor) { free(predictor); }

static unisim_predictor* create(void) {
  int k;
  struct knowing* me = (struct knowing*)calloc(1, sizeof *me);
  if (me == NULL) return NULL;
  for (k = 0; k < kWidth * kHeight; ++k) me->depth[k] = 2.0f;
  me->table.struct_size = sizeof me->table;
  me->table.name = "knowing";
  me->table.observe = observe;
  me->table.keyframe = keyframe;
  me->table.two_view = two_view;
  me->table.multi_view = multi_view;
  me->table.info = info;
  me->table.message = message_of;
  me->table.destroy = destroy;
  return &me->table;
}

static void print_keyframe(const unisim_pose* pose, void* user) {
  (void)user;
  printf("%d %.3f\n", (int)pose->keyframe_id, pose->T_world_kf.t[0]);
}

int main(int argc, char** argv) {
  char message[512] = "";
  unisim_pipeline_config config;
  unisim_pipeline* pipeline;
  if (argc != 2) return fprintf(stderr, "usage: own_predictor SEQUENCE\n"), 2;
  unisim_pipeline_config_init(&config, sizeof config);
  config.source = unisim_sequence_open(argv[1], NULL, message, sizeof message);
  if (config.source == NULL) return fprintf(stderr, "%s\n", message), 3;
  config.predictor = create();
  config.stride = kStep;
  config.on_keyframe = print_keyframe;
  pipeline = unisim_pipeline_start(&config, message, sizeof message);
  if (pipeline == NULL) return fprintf(stderr, "%s\n", message), 1;
  while (unisim_pipeline_poll(pipeline, 1000) == UNISIM_PIPELINE_RUNS) continue;
  fprintf(stderr, "%s\n", unisim_pipeline_message(pipeline));
  return unisim_pipeline_stop(pipeline) != UNISIM_PIPELINE_FINISHED;
}
