/* SPDX-License-Identifier: MIT */
/* From the first camera to poses on LCM: camera_lcm [DEVICE [URL]]. A recording as DEVICE is played
 * at its own pace. */
#include <stdio.h>
#include <string.h>
#include <unisim/lcm_publisher.h>
#include <unisim/pipeline.h>
#include <unisim/sequence.h>
#include <unisim/v4l2.h>

static int is_camera(const char* name) { return name == NULL || strncmp(name, "/dev/", 5) == 0; }

static unisim_source* open_source(const char* name, char* message, size_t capacity) {
  unisim_v4l2_config camera;
  unisim_v4l2_config_init(&camera, sizeof camera);
  camera.device = name;
  return is_camera(name) ? unisim_v4l2_open(&camera, NULL, message, capacity)
                         : unisim_sequence_open(name, NULL, message, capacity);
}

int main(int argc, char** argv) {
  char message[512] = "";
  int how;
  unisim_lcm_publisher_config network = {sizeof network, UNISIM_LCM_UNIT_RELATIVE, 0, 1, NULL};
  unisim_pipeline_config config;
  unisim_pipeline* pipeline;
  unisim_pipeline_config_init(&config, sizeof config);
  network.url = argc > 2 ? argv[2] : NULL;
  config.lcm = unisim_lcm_publisher_create(&network, NULL, message, sizeof message);
  if (config.lcm == NULL) return fprintf(stderr, "%s\n", message), 1;
  config.source = open_source(argv[1], message, sizeof message);
  config.live = is_camera(argv[1]);
  config.realtime = !config.live;
  pipeline = config.source == NULL ? NULL : unisim_pipeline_start(&config, message, sizeof message);
  if (pipeline == NULL) return fprintf(stderr, "%s\n", message), 1;
  while (unisim_pipeline_poll(pipeline, 1000) == UNISIM_PIPELINE_RUNS) continue;
  fprintf(stderr, "%s\n", unisim_pipeline_message(pipeline));
  how = unisim_pipeline_stop(pipeline);
  unisim_lcm_publisher_destroy(config.lcm); /* after the pipeline, which uses it */
  return how == UNISIM_PIPELINE_FAILED;
}
