// SPDX-License-Identifier: MIT
// Elements of the drawings.
#include "tools/replay/report/svg.hpp"

#include "tools/replay/report/text.hpp"

namespace unisim::report {

std::string svg_line(double x1, double y1, double x2, double y2, const std::string& style) {
  std::string svg = "<line class=\"" + style + "\" x1=\"" + coordinate(x1);
  svg += "\" x2=\"" + coordinate(x2);
  svg += "\" y1=\"" + coordinate(y1);
  svg += "\" y2=\"" + coordinate(y2);
  return svg + "\"/>";
}

std::string svg_text(double x, double y, const std::string& anchor, const std::string& text,
                     const std::string& style) {
  std::string svg = "<text class=\"" + style + "\" text-anchor=\"" + anchor;
  svg += "\" x=\"" + coordinate(x);
  svg += "\" y=\"" + coordinate(y);
  return svg + "\">" + escape(text) + "</text>";
}

std::string svg_upright_text(double x, double y, const std::string& text) {
  std::string svg = "<text class=\"name\" text-anchor=\"middle\" transform=\"translate(";
  svg += coordinate(x) + " " + coordinate(y);
  return svg + ") rotate(-90)\">" + escape(text) + "</text>";
}

}  // namespace unisim::report
