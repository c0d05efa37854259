// SPDX-License-Identifier: MIT
// A chart of values over time, drawn as SVG.
#include "tools/replay/report/chart.hpp"

#include <algorithm>
#include <cmath>

#include "tools/replay/report/axis.hpp"
#include "tools/replay/report/svg.hpp"
#include "tools/replay/report/text.hpp"

namespace unisim::report {
namespace {

constexpr int kWidth = 460;
constexpr double kLeft = 58.0;
constexpr double kRight = 10.0;
constexpr double kTop = 12.0;
constexpr double kBottom = 38.0;      // with time labels
constexpr double kBottomBare = 10.0;  // without
constexpr std::size_t kMostSamples = 1200;

Axis value_axis(const Chart& chart, double bottom) {
  Range range;
  for (const Series& series : chart.series) {
    for (const Sample& sample : series.samples) range.add(sample.value);
  }
  if (chart.reference.shown) range.add(chart.reference.value);
  if (chart.from_zero) range.add(0.0);
  if (range.empty()) range.add(0.0);
  constexpr double kMargin = 0.06;
  return {chart.from_zero ? 0.0 : range.low(kMargin), range.high(kMargin), bottom, kTop};
}

std::string draw_value_ticks(const Axis& values, double right) {
  const double step = tick_step(values.low, values.high, values.from - values.to > 120 ? 5 : 3);
  std::string svg;
  for (const double value : ticks(values.low, values.high, step)) {
    const double y = values.pixel(value);
    svg += svg_line(kLeft, y, right, y, "grid");
    svg += svg_text(kLeft - 6, y + 4, "end", tick_label(value, step), "tick");
  }
  return svg;
}

std::string draw_time_ticks(const Chart& chart, const Axis& times, double bottom) {
  const double step = tick_step(times.low, times.high, 6);
  std::string svg;
  for (const double time : ticks(times.low, times.high, step)) {
    const double x = times.pixel(time);
    svg += svg_line(x, kTop, x, bottom, "grid");
    if (chart.time_labels)
      svg += svg_text(x, bottom + 16, "middle", tick_label(time, step), "tick");
  }
  if (chart.time_labels) {
    svg += svg_text((times.from + times.to) / 2, bottom + 33, "middle", "time (s)", "name");
  }
  return svg;
}

std::string draw_series(const Series& series, const Axis& times, const Axis& values,
                        double start_s) {
  std::string path;
  const Sample* before = nullptr;
  for (const Sample& sample : series.samples) {
    if (!std::isfinite(sample.value)) {
      before = nullptr;
      continue;
    }
    const bool joined = before != nullptr && before->segment == sample.segment;
    path += joined ? "L" : "M";
    path += coordinate(times.pixel(sample.time_s - start_s)) + " " +
            coordinate(values.pixel(sample.value));
    before = &sample;
  }
  return "<path class=\"line " + series.style + "\" d=\"" + path + "\"/>";
}

/// Data for the pointer: [{"n":name,"s":style,"p":[[time,value],...]},...]
std::string pointer_data(const std::vector<Series>& all, double start_s) {
  std::string json = "[";
  for (const Series& series : all) {
    if (json.size() > 1) json += ",";
    json += R"({"n":")" + series.name + R"(","s":")" + series.style + R"(","p":[)";
    bool first = true;
    for (const Sample& sample : series.samples) {
      if (!std::isfinite(sample.value)) continue;
      json += first ? "[" : ",[";
      json += coordinate(sample.time_s - start_s) + "," + number(sample.value) + "]";
      first = false;
    }
    json += "]}";
  }
  return json + "]";
}

}  // namespace

std::vector<Sample> thinned(const std::vector<Sample>& samples, size_t most) {
  if (samples.size() <= most || most < 2) return samples;
  std::vector<Sample> kept;
  const size_t stretch = (2 * samples.size() + most - 1) / most;
  const auto less = [](const Sample& a, const Sample& b) { return a.value < b.value; };
  for (size_t first = 0; first < samples.size(); first += stretch) {
    const auto begin = samples.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end =
        samples.begin() + static_cast<std::ptrdiff_t>(std::min(first + stretch, samples.size()));
    const auto extremes = std::minmax_element(begin, end, less);
    const auto early = std::min(extremes.first, extremes.second);
    const auto late = std::max(extremes.first, extremes.second);
    kept.push_back(*early);
    if (late != early) kept.push_back(*late);
  }
  return kept;
}

std::string draw_chart(const Chart& chart) {
  std::vector<Series> series = chart.series;
  for (Series& each : series) each.samples = thinned(each.samples, kMostSamples);
  const double bottom = chart.height - (chart.time_labels ? kBottom : kBottomBare);
  const double right = kWidth - kRight;
  const double length = std::max(chart.end_s - chart.start_s, 1e-3);
  const Axis times = {0.0, length, kLeft, right};
  const Axis values = value_axis(chart, bottom);

  std::string svg =
      "<svg class=\"chart\" role=\"img\" viewBox=\"0 0 " + std::to_string(kWidth) + " " +
      std::to_string(chart.height) + "\" data-left=\"" + coordinate(kLeft) + "\" data-right=\"" +
      coordinate(right) + "\" data-top=\"" + coordinate(kTop) + "\" data-bottom=\"" +
      coordinate(bottom) + "\" data-length=\"" + number(length) + "\" data-series=\"" +
      escape(pointer_data(series, chart.start_s)) + "\"><title>" + escape(chart.title) + "</title>";
  svg += draw_value_ticks(values, right) + draw_time_ticks(chart, times, bottom);
  svg += svg_line(kLeft, bottom, right, bottom, "frame") +
         svg_line(kLeft, kTop, kLeft, bottom, "frame");
  const double middle = (kTop + bottom) / 2;
  svg += svg_upright_text(13, middle, chart.value_name);
  for (const Series& each : series) svg += draw_series(each, times, values, chart.start_s);
  if (chart.reference.shown) {
    const double y = values.pixel(chart.reference.value);
    svg += svg_line(kLeft, y, right, y, "reference");
    svg += svg_text(right - 4, y - 5, "end", chart.reference.label, "reference-label");
  }
  return svg + "</svg>";
}

}  // namespace unisim::report
