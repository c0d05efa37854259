// SPDX-License-Identifier: MIT
// A chart of values over time, drawn as SVG.
#pragma once

#include <string>
#include <vector>

#include "tools/replay/report/report.hpp"

namespace unisim::report {

/// One line of a chart.
struct Series {
  std::string name;
  std::string style;  ///< CSS class: "estimate", "live", "truth"
  std::vector<Sample> samples;
};

/// A horizontal line at a value worth comparing with.
struct Reference {
  bool shown = false;
  double value = 0.0;
  std::string label;
};

struct Chart {
  std::string title;       ///< for readers that cannot see it
  std::string value_name;  ///< what the values are, with unit: "error (m)"
  std::vector<Series> series;
  Reference reference;
  double start_s = 0.0;  ///< times are shown from here
  double end_s = 1.0;
  bool from_zero = false;  ///< values start at 0
  bool time_labels = true;
  int height = 190;  ///< of 460 wide
};

/// The chart as an SVG element, with its data for the pointer.
std::string draw_chart(const Chart& chart);

/// At most about `most` samples: of each stretch the smallest and the largest.
std::vector<Sample> thinned(const std::vector<Sample>& samples, size_t most);

}  // namespace unisim::report
