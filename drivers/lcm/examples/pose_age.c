/* SPDX-License-Identifier: MIT */
/* How old poses are when they get here: pose_age [POSES [URL]]. From the time stamp of the frame to
 * the hand of this program; the publisher's stamps must be times of day, as unisim-live's are with
 * a camera, and both clocks the same. */
#include <lcm/lcm.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/time.h>

#include "unisim_pose_t.h"

typedef struct ages {
  int count;
  int wanted;
  double* ms;
} ages;

static void on_pose(const lcm_recv_buf_t* received, const char* channel, void* user) {
  ages* all = (ages*)user;
  unisim_pose_t pose;
  struct timeval now;
  (void)channel;
  gettimeofday(&now, NULL);
  if (unisim_pose_t_decode(received->data, 0, (int)received->data_size, &pose) < 0) return;
  if (all->count == all->wanted) return;
  all->ms[all->count++] =
      (double)((int64_t)now.tv_sec * 1000000 + (int64_t)now.tv_usec - pose.utime) / 1000.0;
}

static int by_size(const void* a, const void* b) {
  const double x = *(const double*)a, y = *(const double*)b;
  return (x > y) - (x < y);
}

/* Age that this share of all poses does not exceed. */
static double percentile(const ages* all, double share) {
  return all->count == 0 ? 0.0 : all->ms[(int)(share * (all->count - 1) + 0.5)];
}

int main(int argc, char** argv) {
  ages all = {0, 0, NULL};
  lcm_t* lcm = lcm_create(argc > 2 ? argv[2] : NULL);
  all.wanted = argc > 1 ? atoi(argv[1]) : 100;
  all.ms = (double*)calloc(all.wanted > 0 ? (size_t)all.wanted : 1, sizeof *all.ms);
  if (lcm == NULL || all.ms == NULL) {
    fprintf(stderr, "pose_age: no LCM network\n");
    return 4;
  }
  lcm_subscription_set_queue_capacity(lcm_subscribe(lcm, "UNISIM_POSE", on_pose, &all), 0);
  printf("listening\n");
  fflush(stdout);
  while (all.count == 0 && all.wanted > 0 && lcm_handle(lcm) == 0) continue;
  /* Five seconds without a pose: the run has ended. */
  while (all.count < all.wanted && lcm_handle_timeout(lcm, 5000) > 0) continue;
  qsort(all.ms, (size_t)all.count, sizeof *all.ms, by_size);
  printf(
      "%d poses, from the stamp of the frame to here p50 %.1f, p95 %.1f, p99 %.1f, max %.1f ms\n",
      all.count, percentile(&all, 0.5), percentile(&all, 0.95), percentile(&all, 0.99),
      percentile(&all, 1.0));
  free(all.ms);
  lcm_destroy(lcm);
  return 0;
}
