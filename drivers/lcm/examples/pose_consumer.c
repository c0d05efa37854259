/* SPDX-License-Identifier: MIT */
/* Holds the camera's pose as a robot would: live poses, corrections, state and unit, from LCM
 * alone. Prints one line for each message; ends after as many poses as its first argument says. */
#include <lcm/lcm.h>
#include <stdio.h>
#include <stdlib.h>

#include "unisim_correction_t.h"
#include "unisim_pose_t.h"
#include "unisim_status_t.h"

typedef struct robot {
  int poses;
  int foreign;          /* messages of other types on our channels */
  int32_t map_revision; /* the map that `pos` is in */
  int32_t segment;      /* poses of different segments have nothing in common */
  int32_t state;        /* UNISIM_STATUS_T_STATE_* */
  int32_t unit;         /* UNISIM_STATUS_T_UNIT_* */
  int64_t utime;        /* of the pose held */
  double pos[3];
  double orientation[4]; /* w x y z */
} robot;

/* a * b */
static void multiply(const double a[4], const double b[4], double out[4]) {
  const double w = a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3];
  const double x = a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2];
  const double y = a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1];
  const double z = a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0];
  out[0] = w;
  out[1] = x;
  out[2] = y;
  out[3] = z;
}

static void rotate(const double q[4], const double p[3], double out[3]) {
  const double point[4] = {0.0, p[0], p[1], p[2]};
  const double conjugate[4] = {q[0], -q[1], -q[2], -q[3]};
  double turned[4];
  multiply(q, point, turned);
  multiply(turned, conjugate, turned);
  for (int k = 0; k < 3; ++k) out[k] = turned[k + 1];
}

static void print_pose(const robot* me, const char* why) {
  printf("%s utime %lld revision %d pos %.9f %.9f %.9f\n", why, (long long)me->utime,
         (int)me->map_revision, me->pos[0], me->pos[1], me->pos[2]);
}

static void on_pose(const lcm_recv_buf_t* received, const char* channel, void* user) {
  robot* me = (robot*)user;
  unisim_pose_t pose;
  (void)channel;
  if (unisim_pose_t_decode(received->data, 0, (int)received->data_size, &pose) < 0) {
    ++me->foreign;
    return;
  }
  me->utime = pose.utime;
  for (int k = 0; k < 3; ++k) me->pos[k] = pose.pos[k];
  for (int k = 0; k < 4; ++k) me->orientation[k] = pose.orientation[k];
  ++me->poses;
  print_pose(me, "pose");
}

static void on_correction(const lcm_recv_buf_t* received, const char* channel, void* user) {
  robot* me = (robot*)user;
  unisim_correction_t jump;
  double turned[3];
  (void)channel;
  if (unisim_correction_t_decode(received->data, 0, (int)received->data_size, &jump) < 0) {
    ++me->foreign;
    return;
  }
  me->map_revision = jump.map_revision;
  /* A pose that is newer is in the corrected map already; another segment has its own frame. */
  if (me->poses == 0 || me->utime > jump.utime || jump.segment != me->segment) return;
  rotate(jump.jump_orientation, me->pos, turned);
  for (int k = 0; k < 3; ++k) me->pos[k] = jump.jump_scale * turned[k] + jump.jump_pos[k];
  multiply(jump.jump_orientation, me->orientation, me->orientation);
  print_pose(me, "corrected");
}

static void on_status(const lcm_recv_buf_t* received, const char* channel, void* user) {
  robot* me = (robot*)user;
  unisim_status_t status;
  (void)channel;
  if (unisim_status_t_decode(received->data, 0, (int)received->data_size, &status) < 0) {
    ++me->foreign;
    return;
  }
  me->state = status.state;
  me->unit = status.unit;
  if (status.segment >= 0) me->segment = status.segment;
  printf("status state %d confidence %d unit %s segment %d revision %d\n", (int)status.state,
         (int)status.confidence,
         status.unit == UNISIM_STATUS_T_UNIT_METRIC ? "metres" : "of the map", (int)status.segment,
         (int)status.map_revision);
  unisim_status_t_decode_cleanup(&status);
}

int main(int argc, char** argv) {
  const int wanted = argc > 1 ? atoi(argv[1]) : 100;
  const char* url = argc > 2 ? argv[2] : NULL;
  robot me = {0};
  lcm_t* lcm = lcm_create(url);
  if (lcm == NULL) {
    fprintf(stderr, "pose_consumer: no LCM network\n");
    return 4;
  }
  lcm_subscription_set_queue_capacity(lcm_subscribe(lcm, "UNISIM_POSE", on_pose, &me), 0);
  lcm_subscription_set_queue_capacity(lcm_subscribe(lcm, "UNISIM_CORRECTION", on_correction, &me),
                                      0);
  lcm_subscribe(lcm, "UNISIM_STATUS", on_status, &me);
  printf("listening\n");
  fflush(stdout);
  while (me.poses < wanted && lcm_handle(lcm) == 0) fflush(stdout);
  printf("done poses %d foreign %d\n", me.poses, me.foreign);
  lcm_destroy(lcm);
  return me.foreign == 0 ? 0 : 3;
}
