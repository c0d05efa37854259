// SPDX-License-Identifier: MIT
// Text for HTML and SVG.
#include "tools/replay/report/text.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/common/format.hpp"
#include "tools/common/text.hpp"

namespace unisim::report {
namespace {

using drivers::format;

}  // namespace

std::string escape(const std::string& text) {
  std::string out;
  for (const char c : tools::valid_utf8(text)) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        if (static_cast<unsigned char>(c) >= 0x20 || c == '\n') out += c;
    }
  }
  return out;
}

std::string coordinate(double value) {
  std::string text = format("%.2f", value);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string number(double value) { return format("%.4g", value); }

std::string short_number(double value) { return format("%.3g", value); }

std::string milliseconds(double value) { return format("%.2f", value); }

std::string tick_label(double value, double step) {
  const int decimals = std::clamp(static_cast<int>(-std::floor(std::log10(step) + 1e-9)), 0, 9);
  if (std::abs(value) < 0.5 * step) value = 0.0;
  return format("%.*f", decimals, value);
}

}  // namespace unisim::report
