// SPDX-License-Identifier: MIT
// Text for HTML and SVG.
#include "tools/replay/report/text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tools/common/text.hpp"

namespace unisim::report {
namespace {

std::string print(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

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
  std::string text = print("%.2f", value);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string number(double value) { return print("%.4g", value); }

std::string short_number(double value) { return print("%.3g", value); }

std::string milliseconds(double value) { return print("%.2f", value); }

std::string tick_label(double value, double step) {
  const int decimals = std::clamp(static_cast<int>(-std::floor(std::log10(step) + 1e-9)), 0, 9);
  if (std::abs(value) < 0.5 * step) value = 0.0;
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

}  // namespace unisim::report
