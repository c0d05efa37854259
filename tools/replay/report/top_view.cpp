// SPDX-License-Identifier: MIT
// Trajectories seen from above.
#include "tools/replay/report/top_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/replay/report/axis.hpp"
#include "tools/replay/report/svg.hpp"
#include "tools/replay/report/text.hpp"

namespace unisim::report {
namespace {

constexpr double kWidth = 460.0;
constexpr double kHeight = 470.0;
constexpr double kLeft = 58.0;
constexpr double kRight = 10.0;
constexpr double kTop = 12.0;
constexpr double kBottom = 38.0;
constexpr std::size_t kMostPoints = 4000;

double along(const Point& point, int axis) {
  return axis == 0 ? point.x : axis == 1 ? point.y : point.z;
}

/// The axes across and up of the drawing, and the one looked along.
struct Plane {
  int across;
  int up;
};

Plane plane_of(int looked_along) {
  if (looked_along == 0) return {1, 2};
  if (looked_along == 1) return {0, 2};
  return {0, 1};
}

double variance(const std::vector<Point>& points, int axis) {
  double mean = 0.0;
  double square = 0.0;
  double count = 0.0;
  for (const Point& point : points) {
    const double value = along(point, axis);
    if (!std::isfinite(value)) continue;
    count += 1.0;
    const double delta = value - mean;
    mean += delta / count;
    square += delta * (value - mean);
  }
  return count > 0.0 ? square / count : 0.0;
}

/// Two axes of the same scale that hold all points.
struct Frame {
  Axis across;
  Axis up;
};

Frame frame_of(const ReportData& data, const Plane& plane) {
  Range across;
  Range up;
  for (const auto* points : {&data.estimate, &data.truth}) {
    for (const Point& point : *points) {
      across.add(along(point, plane.across));
      up.add(along(point, plane.up));
    }
  }
  if (across.empty()) across.add(0.0);
  if (up.empty()) up.add(0.0);
  constexpr double kMargin = 0.06;
  const double wide = kWidth - kLeft - kRight;
  const double high = kHeight - kTop - kBottom;
  const double unit_per_pixel = std::max((across.high(kMargin) - across.low(kMargin)) / wide,
                                         (up.high(kMargin) - up.low(kMargin)) / high);
  const double middle_across = (across.low() + across.high()) / 2;
  const double middle_up = (up.low() + up.high()) / 2;
  const double half_across = unit_per_pixel * wide / 2;
  const double half_up = unit_per_pixel * high / 2;
  return {{middle_across - half_across, middle_across + half_across, kLeft, kLeft + wide},
          {middle_up - half_up, middle_up + half_up, kTop + high, kTop}};
}

std::string draw_grid(const Frame& frame, const Plane& plane, const std::string& unit) {
  const double step = tick_step(frame.across.low, frame.across.high, 6);
  std::string svg;
  for (const double value : ticks(frame.across.low, frame.across.high, step)) {
    const double x = frame.across.pixel(value);
    svg += svg_line(x, frame.up.to, x, frame.up.from, "grid");
    svg += svg_text(x, frame.up.from + 16, "middle", tick_label(value, step), "tick");
  }
  for (const double value : ticks(frame.up.low, frame.up.high, step)) {
    const double y = frame.up.pixel(value);
    svg += svg_line(frame.across.from, y, frame.across.to, y, "grid");
    svg += svg_text(frame.across.from - 6, y + 4, "end", tick_label(value, step), "tick");
  }
  constexpr std::array<const char*, 3> kNames = {"x", "y", "z"};
  const std::string across = kNames[static_cast<std::size_t>(plane.across)];
  const std::string up = kNames[static_cast<std::size_t>(plane.up)];
  svg += svg_text((frame.across.from + frame.across.to) / 2, kHeight - 4, "middle",
                  across + " (" + unit + ")", "name");
  svg += svg_upright_text(13, (frame.up.from + frame.up.to) / 2, up + " (" + unit + ")");
  return svg;
}

/// A path, each segment of the estimate in its own colour.
std::string draw_path(const std::vector<Point>& points, const std::string& style, bool by_segment,
                      const Frame& frame, const Plane& plane) {
  const std::size_t step = points.size() / kMostPoints + 1;
  std::string svg;
  std::string path;
  int segment = -1;
  const auto close = [&] {
    if (path.empty()) return;
    const std::string colour = by_segment ? " segment" + std::to_string(segment % 4) : "";
    svg += "<path class=\"line " + style + colour + "\" d=\"" + path + "\"/>";
    path.clear();
  };
  for (std::size_t k = 0; k < points.size(); k += step) {
    const double across = frame.across.pixel(along(points[k], plane.across));
    const double up = frame.up.pixel(along(points[k], plane.up));
    if (!std::isfinite(across) || !std::isfinite(up)) continue;
    if (points[k].segment != segment) close();
    segment = points[k].segment;
    path += (path.empty() ? "M" : "L") + coordinate(across) + " " + coordinate(up);
  }
  close();
  return svg;
}

std::string draw_ends(const std::vector<Point>& points, const Frame& frame, const Plane& plane) {
  if (points.empty()) return "";
  const auto dot = [&](const Point& point, const char* style, const char* name) {
    const double x = frame.across.pixel(along(point, plane.across));
    const double y = frame.up.pixel(along(point, plane.up));
    if (!std::isfinite(x) || !std::isfinite(y)) return std::string();
    const bool at_right = x > kWidth - 60.0;
    std::string svg = "<circle class=\"" + std::string(style) + "\" r=\"4.5\" cx=\"";
    svg += coordinate(x) + "\" cy=\"" + coordinate(y) + "\"/>";
    return svg +
           svg_text(at_right ? x - 9 : x + 9, y + 4, at_right ? "end" : "start", name, "end-label");
  };
  return dot(points.front(), "start", "start") + dot(points.back(), "end", "end");
}

}  // namespace

int view_axis(const ReportData& data) {
  const std::vector<Point>& points = data.truth.empty() ? data.estimate : data.truth;
  const std::array<double, 3> motion = {variance(points, 0), variance(points, 1),
                                        variance(points, 2)};
  return static_cast<int>(std::min_element(motion.begin(), motion.end()) - motion.begin());
}

std::string draw_top_view(const ReportData& data) {
  const Plane plane = plane_of(view_axis(data));
  const Frame frame = frame_of(data, plane);
  const std::string unit = data.length_unit.empty() ? "map unit" : data.length_unit;
  std::string svg = "<svg class=\"view\" role=\"img\" viewBox=\"0 0 " + coordinate(kWidth) + " " +
                    coordinate(kHeight) + "\"><title>Trajectory from above</title>";
  svg += "<clipPath id=\"top-view\"><rect x=\"" + coordinate(kLeft) + "\" y=\"" + coordinate(kTop) +
         "\" width=\"" + coordinate(kWidth - kLeft - kRight) + "\" height=\"" +
         coordinate(kHeight - kTop - kBottom) + "\"/></clipPath>";
  svg += draw_grid(frame, plane, unit);
  svg += "<rect class=\"frame\" x=\"" + coordinate(kLeft) + "\" y=\"" + coordinate(kTop) +
         "\" width=\"" + coordinate(kWidth - kLeft - kRight) + "\" height=\"" +
         coordinate(kHeight - kTop - kBottom) + "\"/><g clip-path=\"url(#top-view)\">";
  svg += draw_path(data.truth, "truth", false, frame, plane);
  svg += draw_path(data.live, "live", false, frame, plane);
  svg += draw_path(data.estimate, "estimate", true, frame, plane);
  return svg + draw_ends(data.estimate, frame, plane) + "</g></svg>";
}

}  // namespace unisim::report
