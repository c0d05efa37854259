/* SPDX-License-Identifier: MIT */
/* What a compiler is given behind a header. */
extern int unisim_header_probe;
