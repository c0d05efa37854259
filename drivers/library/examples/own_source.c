/* SPDX-License-Identifier: MIT */
/* A source of one's own: frames that the program makes, here a textured wall that slides by. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unisim/pipeline.h>

enum { kWidth = 320, kHeight = 240, kFrames = 60 };

struct wall {
  unisim_source table; /* first: the library hands this pointer back */
  int64_t next;
  uint8_t pixels[kWidth * kHeight];
};

static int64_t frame_count(unisim_source* source) {
  (void)source;
  return kFrames;
}

/* Gray value of the wall at a point: a checkerboard of random cells. */
static uint8_t wall_at(double x, double y) {
  uint32_t cell = (uint32_t)(int32_t)floor(x / 12) * 2654435761u ^
                  (uint32_t)(int32_t)floor(y / 12) * 2246822519u;
  cell ^= cell >> 15;
  cell *= 2246822519u;
  return (uint8_t)(40 + (cell >> 24) * 3 / 4);
}

/* Two layers, the near one of horizontal stripes moves twice as far. */
static int next_frame(unisim_source* source, int decode, unisim_frame* frame) {
  struct wall* wall = (struct wall*)source;
  double shift = 3.0 * (double)wall->next;
  int x, y;
  if (wall->next == kFrames) return UNISIM_FRAME_END;
  for (y = 0; decode && y < kHeight; ++y) {
    double depth = y / 40 % 2 == 0 ? 1.0 : 2.0;
    for (x = 0; x < kWidth; ++x) {
      wall->pixels[y * kWidth + x] = wall_at(x + shift * depth, y);
    }
  }
  frame->index = wall->next;
  frame->timestamp_ns = wall->next++ * 33333333;
  frame->image.data = decode ? wall->pixels : NULL;
  frame->image.width = frame->image.stride = kWidth;
  frame->image.height = kHeight;
  frame->image.format = UNISIM_PIXEL_GRAY8;
  return UNISIM_FRAME_OK;
}

static int64_t ground_truth(unisim_source* source, const unisim_stamped_pose** poses) {
  (void)source;
  *poses = NULL;
  return 0;
}

static const char* nothing(unisim_source* source) {
  (void)source;
  return "";
}

static void destroy(unisim_source* source) { free(source); }

static void count_pose(const unisim_live_pose* pose, void* user) {
  (void)pose;
  ++*(int*)user;
}

int main(void) {
  char message[512] = "";
  int poses = 0;
  unisim_pipeline_config config;
  unisim_pipeline* pipeline;
  struct wall* wall = (struct wall*)calloc(1, sizeof *wall);
  if (wall == NULL) return 1;
  wall->table.struct_size = sizeof wall->table;
  wall->table.format = "wall";
  wall->table.frame_count = frame_count;
  wall->table.next_frame = next_frame;
  wall->table.ground_truth = ground_truth;
  wall->table.ground_truth_path = nothing;
  wall->table.message = nothing;
  wall->table.destroy = destroy;
  unisim_pipeline_config_init(&config, sizeof config);
  config.source = &wall->table; /* the pipeline destroys it */
  config.on_pose = count_pose;
  config.user = &poses;
  pipeline = unisim_pipeline_start(&config, message, sizeof message);
  if (pipeline == NULL) return fprintf(stderr, "%s\n", message), 1;
  while (unisim_pipeline_poll(pipeline, 1000) == UNISIM_PIPELINE_RUNS) continue;
  fprintf(stderr, "%s\n", unisim_pipeline_message(pipeline));
  if (unisim_pipeline_stop(pipeline) != UNISIM_PIPELINE_FINISHED) return 1;
  printf("%d poses\n", poses);
  return 0;
}
