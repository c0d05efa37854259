// SPDX-License-Identifier: MIT
// Style and script of the page of results.
#pragma once

namespace unisim::report {

extern const char* const kStyle;   ///< CSS, light and dark
extern const char* const kScript;  ///< reads values off the charts under the pointer

}  // namespace unisim::report
