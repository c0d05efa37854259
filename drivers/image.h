/* SPDX-License-Identifier: MIT */
/** @file image.h  A view of one image, as sources give and predictors take it. */
#ifndef UNISIM_DRIVERS_IMAGE_H
#define UNISIM_DRIVERS_IMAGE_H

#include <stdint.h>

#define UNISIM_PIXEL_GRAY8 1
#define UNISIM_PIXEL_BGR8 3

/** Borrowed pixels: valid until the next call on the object that gave them. */
typedef struct unisim_image {
  const uint8_t* data; /**< NULL: not decoded */
  int32_t width;       /**< pixels */
  int32_t height;
  int32_t stride; /**< bytes from row to row */
  int32_t format; /**< UNISIM_PIXEL_*; the number is also the bytes per pixel */
} unisim_image;

#endif
