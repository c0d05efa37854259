/* SPDX-License-Identifier: MIT */
/* Answers as an ONNX Runtime does that is too old for this driver. */
#include <stddef.h>
#include <stdint.h>

struct api_base {
  const void* (*get_api)(uint32_t version);
  const char* (*version)(void);
};

static const void* get_api(uint32_t version) {
  (void)version;
  return NULL;
}

static const char* version(void) { return "1.16.3"; }

__attribute__((visibility("default"))) const struct api_base* OrtGetApiBase(void);

const struct api_base* OrtGetApiBase(void) {
  static const struct api_base base = {get_api, version};
  return &base;
}
