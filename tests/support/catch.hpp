// SPDX-License-Identifier: MIT
// One include for Catch2 2.13 (Debian 12, Ubuntu 22.04) and 3.x (newer).
#pragma once

#if __has_include(<catch2/catch_all.hpp>)
#define UNISIM_CATCH_V3 1
#include <catch2/catch_all.hpp>
using Catch::Approx;
#else
#define UNISIM_CATCH_V3 0
#ifdef UNISIM_CATCH_RUNNER
#define CATCH_CONFIG_RUNNER
#endif
#include <catch2/catch.hpp>
#endif
