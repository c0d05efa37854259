// SPDX-License-Identifier: MIT
// Elements of the drawings.
#pragma once

#include <string>

namespace unisim::report {

/// A straight line; `style` is its CSS class.
std::string svg_line(double x1, double y1, double x2, double y2, const std::string& style);

/// Text at a place; `anchor` is start, middle or end. The text is escaped.
std::string svg_text(double x, double y, const std::string& anchor, const std::string& text,
                     const std::string& style);

/// Text that runs upwards, centred on a place.
std::string svg_upright_text(double x, double y, const std::string& text);

}  // namespace unisim::report
