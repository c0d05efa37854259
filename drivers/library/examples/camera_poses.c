/* SPDX-License-Identifier: MIT */
/* From the first camera to poses on the terminal: camera_poses [DEVICE] */
#include <stdio.h>
#include <unisim/pipeline.h>
#include <unisim/v4l2.h>

static void print_pose(const unisim_live_pose* pose, void* user) {
  const double* t = pose->T_world_cam.t;
  (void)user;
  printf("%.6f %.4f %.4f %.4f\n", (double)pose->timestamp_ns * 1e-9, t[0], t[1], t[2]);
}

int main(int argc, char** argv) {
  char message[512] = "";
  unisim_v4l2_config camera;
  unisim_pipeline_config config;
  unisim_pipeline* pipeline;
  unisim_v4l2_config_init(&camera, sizeof camera);
  camera.device = argc > 1 ? argv[1] : NULL;
  unisim_pipeline_config_init(&config, sizeof config);
  config.source = unisim_v4l2_open(&camera, NULL, message, sizeof message);
  config.live = 1;
  config.on_pose = print_pose;
  pipeline = config.source == NULL ? NULL : unisim_pipeline_start(&config, message, sizeof message);
  if (pipeline == NULL) return fprintf(stderr, "%s\n", message), 1;
  while (unisim_pipeline_poll(pipeline, 1000) == UNISIM_PIPELINE_RUNS) fflush(stdout);
  fprintf(stderr, "%s\n", unisim_pipeline_message(pipeline));
  return unisim_pipeline_stop(pipeline) == UNISIM_PIPELINE_FAILED;
}
