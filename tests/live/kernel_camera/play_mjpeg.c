/* SPDX-License-Identifier: MIT */
/* Plays JPEG images into a loopback camera, as a camera that compresses would give them:
 * play_mjpeg DEVICE WIDTH HEIGHT MILLISECONDS GO < LIST
 * The first image again and again until the file GO is there, then each of the list once. */
#define _POSIX_C_SOURCE 200809L
#include <fcntl.h>
#include <linux/videodev2.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

static char image[1 << 20];

static int fail(const char* what) {
  perror(what);
  return 1;
}

/* Bytes of the next image of the list, 0 after the last, -1 where it cannot be read. */
static long next_image(void) {
  char path[4096];
  long bytes = -1;
  FILE* file;
  if (fgets(path, sizeof path, stdin) == NULL) return 0;
  path[strcspn(path, "\n")] = '\0';
  file = fopen(path, "rb");
  if (file == NULL) return -1;
  bytes = (long)fread(image, 1, sizeof image, file);
  fclose(file);
  return bytes;
}

static void wait_for(struct timespec* due, long ms) {
  due->tv_nsec += ms % 1000 * 1000000L;
  due->tv_sec += ms / 1000 + due->tv_nsec / 1000000000L;
  due->tv_nsec %= 1000000000L;
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, due, NULL);
}

int main(int argc, char** argv) {
  struct v4l2_format format;
  struct timespec due;
  long bytes;
  int camera;
  int goes = 0;
  if (argc != 6) return 2;
  camera = open(argv[1], O_RDWR);
  if (camera < 0) return fail(argv[1]);
  memset(&format, 0, sizeof format);
  format.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  format.fmt.pix.width = (unsigned)atoi(argv[2]);
  format.fmt.pix.height = (unsigned)atoi(argv[3]);
  format.fmt.pix.pixelformat = V4L2_PIX_FMT_MJPEG;
  format.fmt.pix.field = V4L2_FIELD_NONE;
  format.fmt.pix.sizeimage = sizeof image;
  if (ioctl(camera, VIDIOC_S_FMT, &format) < 0) return fail("VIDIOC_S_FMT");
  clock_gettime(CLOCK_MONOTONIC, &due);
  for (bytes = next_image(); bytes > 0;) {
    if (write(camera, image, (size_t)bytes) < 0) return fail("write");
    wait_for(&due, atol(argv[4]));
    if (goes) bytes = next_image();
    goes = access(argv[5], F_OK) == 0;
  }
  return bytes < 0 ? fail("an image") : 0;
}
