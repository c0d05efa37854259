// SPDX-License-Identifier: MIT
// The page of results: one self-contained HTML file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace unisim::report {

/// A position at a time.
struct Point {
  double time_s = 0.0;
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
  int segment = 0;  ///< lines are broken between segments; 0, 1, 2 ...
};

/// A value at a time.
struct Sample {
  double time_s = 0.0;
  double value = 0.0;
  int segment = 0;
};

/// A key figure, shown large.
struct Figure {
  std::string label;  ///< "ATE, final poses"
  std::string value;  ///< with its unit: "10.1 mm"
  std::string note;   ///< one short line below, may be empty
};

/// Name and value of a table.
struct Row {
  std::string name;
  std::string value;
};

struct TimingRow {
  std::string stage;
  int64_t count = 0;
  double p50_ms = 0.0;
  double p95_ms = 0.0;
  double max_ms = 0.0;
};

/// All that is on the page. Parts that are empty are left out. Texts may hold any characters.
struct ReportData {
  std::string title;     ///< name of the sequence
  std::string subtitle;  ///< one line: predictor, keyframe choice
  std::string footer;    ///< program and version

  std::vector<Figure> figures;
  std::vector<Row> protocol;

  std::string length_unit;  ///< "m": aligned to ground truth, or metric; empty: the map's own unit

  /// Positions in one common frame: that of the ground truth where there is one (then estimate and
  /// live poses are aligned to it).
  std::vector<Point> estimate;  ///< keyframes, final poses
  std::vector<Point> live;      ///< as first given out
  std::vector<Point> truth;

  std::vector<Sample> error;       ///< distance to the truth, final poses
  std::vector<Sample> live_error;  ///< the same of the live poses
  std::vector<Sample> scale;       ///< local scale against the truth, see local_scale()

  std::vector<TimingRow> timing;
  std::vector<Row> memory;
  std::vector<std::string> warnings;  ///< unreadable frames, restarts, what else a reader must know
};

/// The page: HTML with its style and script, no reference to anything outside.
std::string report_html(const ReportData& data);

}  // namespace unisim::report
