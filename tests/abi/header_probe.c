/* SPDX-License-Identifier: MIT */
/* The public header alone, first in the file, twice. */
#include <unisim/places.h>
#include <unisim/unisim.h>

int unisim_header_probe(void);
int unisim_header_probe(void) {
  return UNISIM_VERSION_NUMBER > 0 ? UNISIM_OK : UNISIM_ERR_INTERNAL;
}
