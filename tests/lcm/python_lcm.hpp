// SPDX-License-Identifier: MIT
// A Python that knows LCM and our messages.
#pragma once

#include <string>

namespace unisim::testing {

/// The interpreter: UNISIM_LCM_PYTHON of the environment, or that of the build.
std::string python();

/// Has lcm-gen make the classes of our messages in the folder, and sets PYTHONPATH so that python()
/// finds them and the module lcm, that of tools/fetch_lcm.sh where it is there.
/// @return "", or why python() has no module lcm
std::string prepare_python(const std::string& folder);

#define UNISIM_SKIP_WITHOUT_PYTHON_LCM(folder)                             \
  {                                                                        \
    const std::string no_module = unisim::testing::prepare_python(folder); \
    if (!no_module.empty()) {                                              \
      WARN("skipped: " << no_module);                                      \
      return;                                                              \
    }                                                                      \
  }

}  // namespace unisim::testing
