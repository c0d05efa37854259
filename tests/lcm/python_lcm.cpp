// SPDX-License-Identifier: MIT
// A Python that knows LCM and our messages.
#include "tests/lcm/python_lcm.hpp"

#include <cstdlib>

#include "tests/support/catch.hpp"

namespace unisim::testing {

std::string python() {
  const char* own = std::getenv("UNISIM_LCM_PYTHON");
  return own != nullptr ? own : UNISIM_PYTHON;
}

std::string prepare_python(const std::string& folder) {
  setenv("PYTHONPATH", (folder + ":" + UNISIM_LCM_WHEEL).c_str(), 1);
  if (std::system((python() + " -c 'import lcm' 2> /dev/null").c_str()) != 0) {
    return "no Python module lcm (tools/fetch_lcm.sh, or UNISIM_LCM_PYTHON names a Python with it)";
  }
  const std::string make = std::string(UNISIM_LCM_GEN) + " --python --ppath " + folder + " " +
                           UNISIM_LCM_MESSAGES + "/*.lcm";
  REQUIRE(std::system(make.c_str()) == 0);
  return "";
}

}  // namespace unisim::testing
