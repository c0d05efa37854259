// SPDX-License-Identifier: MIT
// Text for HTML and SVG: escaped, numbers short.
#pragma once

#include <string>

namespace unisim::report {

/// Text as it may stand in an element or a double-quoted attribute; control characters are dropped,
/// bytes that are not UTF-8 replaced.
std::string escape(const std::string& text);

/// A coordinate of a drawing: two decimals at most.
std::string coordinate(double value);

/// A number of four significant digits.
std::string number(double value);

/// A number of three significant digits.
std::string short_number(double value);

/// A duration with two decimals.
std::string milliseconds(double value);

/// A tick label: as many decimals as the step between ticks needs.
std::string tick_label(double value, double step);

}  // namespace unisim::report
