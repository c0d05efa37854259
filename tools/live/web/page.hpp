// SPDX-License-Identifier: MIT
// The page, as one text: made by the build of page.html, page.css and page.js.
#pragma once

namespace unisim::live::web {

extern const char* const kPage;

}  // namespace unisim::live::web
