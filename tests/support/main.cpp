// SPDX-License-Identifier: MIT
// Catch2's main, compiled once for all test programs.
#define UNISIM_CATCH_RUNNER
#include "tests/support/catch.hpp"

int main(int argc, char** argv) { return Catch::Session().run(argc, argv); }
