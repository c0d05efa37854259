// SPDX-License-Identifier: MIT
// The page of results.
#include "tools/replay/report/report.hpp"

#include <algorithm>
#include <cmath>

#include "tools/replay/report/axis.hpp"
#include "tools/replay/report/chart.hpp"
#include "tools/replay/report/page_parts.hpp"
#include "tools/replay/report/text.hpp"
#include "tools/replay/report/top_view.hpp"

namespace unisim::report {
namespace {

/// Times that all charts share.
struct Span {
  double start_s = 0.0;
  double end_s = 1.0;
};

Span span_of(const ReportData& data) {
  Range range;
  for (const auto* points : {&data.estimate, &data.live}) {
    for (const Point& point : *points) range.add(point.time_s);
  }
  if (range.empty()) return {};
  return {range.low(), std::max(range.high(), range.low() + 1e-3)};
}

/// The truth of the time of the run only: it may be that of a longer sequence.
ReportData clipped(const ReportData& data, const Span& span) {
  ReportData out = data;
  constexpr double kSlackSeconds = 0.01;
  const auto outside = [&](const Point& point) {
    return point.time_s < span.start_s - kSlackSeconds || point.time_s > span.end_s + kSlackSeconds;
  };
  out.truth.erase(std::remove_if(out.truth.begin(), out.truth.end(), outside), out.truth.end());
  return out;
}

std::string unit_of(const ReportData& data) {
  return data.length_unit.empty() ? "map unit" : data.length_unit;
}

double root_mean_square(const std::vector<Sample>& samples) {
  double sum = 0.0;
  double count = 0.0;
  for (const Sample& sample : samples) {
    if (!std::isfinite(sample.value)) continue;
    sum += sample.value * sample.value;
    count += 1.0;
  }
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

std::string figures_html(const ReportData& data) {
  if (data.figures.empty()) return "";
  std::string html = "<div class=\"figures\">\n";
  for (const Figure& figure : data.figures) {
    html += "<div class=\"figure\"><div class=\"label\">" + escape(figure.label) +
            "</div><div class=\"value\">" + escape(figure.value) + "</div>";
    if (!figure.note.empty()) html += "<div class=\"note\">" + escape(figure.note) + "</div>";
    html += "</div>\n";
  }
  return html + "</div>\n";
}

std::string warnings_html(const ReportData& data) {
  if (data.warnings.empty()) return "";
  std::string html = "<section class=\"warnings\"><h2>Worth knowing</h2><ul>\n";
  for (const std::string& warning : data.warnings) html += "<li>" + escape(warning) + "</li>\n";
  return html + "</ul></section>\n";
}

int segment_count(const ReportData& data) {
  int most = 0;
  for (const Point& point : data.estimate) most = std::max(most, point.segment + 1);
  return most;
}

std::string legend_entry(const std::string& style, const std::string& name) {
  return "<span><i class=\"" + style + "\"></i>" + name + "</span>";
}

std::string legend_html(bool live, bool truth, int segments) {
  std::string html = "<div class=\"legend\">";
  html += legend_entry("estimate", segments > 1 ? "segment 1" : "final poses");
  for (int k = 1; k < std::min(segments, 4); ++k) {
    html += legend_entry("segment" + std::to_string(k), "segment " + std::to_string(k + 1));
  }
  if (live) html += legend_entry("live", "live poses");
  if (truth) html += legend_entry("truth", "ground truth");
  return html + "</div>";
}

std::string top_view_html(const ReportData& data) {
  constexpr const char* kNames[] = {"x", "y", "z"};
  const int segments = segment_count(data);
  std::string html = "<section><h2>From above</h2>";
  html += legend_html(!data.live.empty(), !data.truth.empty(), segments);
  html += draw_top_view(data);
  html += "<p>Seen along " + std::string(kNames[view_axis(data)]) +
          ", the axis with the least motion; both axes in one scale.";
  if (segments > 1 && data.truth.empty()) {
    html += " Segments have no common frame or scale: each is drawn in its own.";
  }
  return html + "</p></section>\n";
}

std::vector<Sample> component(const std::vector<Point>& points, int axis) {
  std::vector<Sample> samples;
  for (const Point& point : points) {
    const double value = axis == 0 ? point.x : axis == 1 ? point.y : point.z;
    samples.push_back({point.time_s, value, point.segment});
  }
  return samples;
}

std::string axes_html(const ReportData& data, const Span& span) {
  std::string html = "<section><h2>Position over time</h2>";
  html += legend_html(!data.live.empty(), !data.truth.empty(), 1);
  constexpr const char* kNames[] = {"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    Chart chart;
    chart.title = std::string("Position along ") + kNames[axis];
    chart.value_name = std::string(kNames[axis]) + " (" + unit_of(data) + ")";
    chart.start_s = span.start_s;
    chart.end_s = span.end_s;
    chart.time_labels = axis == 2;
    chart.height = axis == 2 ? 178 : 150;
    if (!data.truth.empty()) {
      chart.series.push_back({"ground truth", "truth", component(data.truth, axis)});
    }
    if (!data.live.empty()) chart.series.push_back({"live", "live", component(data.live, axis)});
    chart.series.push_back({"final", "estimate", component(data.estimate, axis)});
    html += draw_chart(chart);
  }
  return html + "</section>\n";
}

std::string error_html(const ReportData& data, const Span& span) {
  if (data.error.empty()) return "";
  Chart chart;
  chart.title = "Distance to the ground truth";
  chart.value_name = "error (" + unit_of(data) + ")";
  chart.start_s = span.start_s;
  chart.end_s = span.end_s;
  chart.from_zero = true;
  chart.height = 230;
  if (!data.live_error.empty()) chart.series.push_back({"live", "live", data.live_error});
  chart.series.push_back({"final", "estimate", data.error});
  const double rmse = root_mean_square(data.error);
  chart.reference = {true, rmse, "RMSE " + short_number(rmse) + " " + unit_of(data)};
  return "<section><h2>Error over time</h2>" + legend_html(!data.live_error.empty(), false, 1) +
         draw_chart(chart) + "<p>Distance to the ground truth after alignment.</p></section>\n";
}

std::string scale_html(const ReportData& data, const Span& span) {
  if (data.scale.empty()) return "";
  Chart chart;
  chart.title = "Local scale";
  chart.value_name = "scale";
  chart.start_s = span.start_s;
  chart.end_s = span.end_s;
  chart.height = 230;
  chart.series.push_back({"scale", "estimate", data.scale});
  chart.reference = {true, 1.0, "ground truth"};
  return "<section><h2>Scale over time</h2>" + legend_html(false, false, 1) + draw_chart(chart) +
         "<p>Size of each short piece over its size in the ground truth, after one alignment of "
         "the "
         "whole.</p></section>\n";
}

std::string rows_html(const char* title, const std::vector<Row>& rows) {
  if (rows.empty()) return "";
  std::string html = "<section><h2>" + std::string(title) + "</h2><table>\n";
  for (const Row& row : rows) {
    html += "<tr><th>" + escape(row.name) + "</th><td>" + escape(row.value) + "</td></tr>\n";
  }
  return html + "</table></section>\n";
}

std::string timing_html(const ReportData& data) {
  if (data.timing.empty()) return "";
  double longest = 1e-9;
  for (const TimingRow& row : data.timing) longest = std::max(longest, row.p95_ms);
  std::string html =
      "<section><h2>Time by stage (ms)</h2><div class=\"scroll\"><table class=\"numbers\">"
      "<tr><th>stage</th><th>calls</th><th>median</th><th>p95</th><th>max</th>"
      "<th class=\"bar\"></th></tr>\n";
  for (const TimingRow& row : data.timing) {
    html += "<tr><td>" + escape(row.stage) + "</td><td>" + std::to_string(row.count) + "</td><td>" +
            milliseconds(row.p50_ms) + "</td><td>" + milliseconds(row.p95_ms) + "</td><td>" +
            milliseconds(row.max_ms) +
            "</td><td class=\"bar\"><b style=\"width:" + coordinate(100.0 * row.p95_ms / longest) +
            "%\"></b></td></tr>\n";
  }
  return html + "</table></div></section>\n";
}

std::string pair_html(const std::string& left, const std::string& right) {
  return left.empty() && right.empty() ? "" : "<div class=\"pair\">\n" + left + right + "</div>\n";
}

/// Two parts one above the other.
std::string stack_html(const std::string& upper, const std::string& lower) {
  return upper.empty() && lower.empty() ? "" : "<div class=\"stack\">" + upper + lower + "</div>\n";
}

}  // namespace

std::string report_html(const ReportData& given) {
  const Span span = span_of(given);
  const ReportData data = clipped(given, span);
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
      escape(data.title) + "</title>\n<style>" + kStyle + "</style></head>\n<body><main>\n";
  html +=
      "<header><h1>" + escape(data.title) + "</h1><p>" + escape(data.subtitle) + "</p></header>\n";
  html += figures_html(data) + warnings_html(data);
  if (!data.estimate.empty()) {
    html += pair_html(top_view_html(data), axes_html(data, span));
    html += pair_html(error_html(data, span), scale_html(data, span));
  }
  html += pair_html(stack_html(timing_html(data), rows_html("Memory", data.memory)),
                    stack_html(rows_html("Protocol", data.protocol), ""));
  html += "<footer>" + escape(data.footer) + "</footer>\n</main>\n<div id=\"readout\"></div>\n";
  return html + "<script>" + kScript + "</script>\n</body></html>\n";
}

}  // namespace unisim::report
