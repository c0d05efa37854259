// SPDX-License-Identifier: MIT
// The page of results: everything on it, nothing from outside, no name taken as markup.
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/catch.hpp"
#include "tools/replay/report/report.hpp"
#include "tools/replay/report/top_view.hpp"

using namespace unisim::report;

namespace {

/// A circle of radius 2 in x and z, with ground truth, errors and tables.
ReportData full_data() {
  ReportData data;
  data.title = "kitchen";
  data.subtitle = "geometric predictor";
  data.footer = "unisim-replay";
  data.figures = {{"ATE RMSE", "10.1 mm", "100 keyframes"}};
  data.protocol = {{"alignment", "sim3"}};
  data.length_unit = "m";
  for (int k = 0; k < 50; ++k) {
    const double angle = 0.1 * k;
    const double time = 1.6e9 + 0.2 * k;
    const Point truth = {time, 2 * std::cos(angle), 0.01 * std::sin(5 * angle), 2 * std::sin(angle),
                         0};
    Point estimate = truth;
    estimate.x += 0.01;
    data.truth.push_back(truth);
    data.estimate.push_back(estimate);
    data.live.push_back(estimate);
    data.error.push_back({time, 0.01, 0});
    data.live_error.push_back({time, 0.02, 0});
    data.scale.push_back({time, 1.02, 0});
  }
  data.timing = {{"two_view", 99, 0.25, 0.5, 1.125}};
  data.memory = {{"session arena", "12.4 MB"}};
  data.warnings = {"3 frames unreadable"};
  return data;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

size_t count(const std::string& text, const std::string& part) {
  size_t found = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

/// A coordinate or value that is no number, as printf writes it.
bool has_broken_number(const std::string& page) {
  for (const char* word : {"nan", "inf"}) {
    for (const char* before : {" ", ",", "L", "M", "\"", "-"}) {
      for (const char* after : {" ", ",", "L", "\"", "]"}) {
        if (contains(page, std::string(before) + word + after)) return true;
      }
    }
  }
  return false;
}

struct GridLine {
  double x1, x2, y1, y2;
};

std::vector<GridLine> grid_lines(const std::string& svg) {
  const std::string start = "<line class=\"grid\"";
  std::vector<GridLine> lines;
  for (size_t at = svg.find(start); at != std::string::npos; at = svg.find(start, at + 1)) {
    GridLine line{};
    const char* text = svg.c_str() + at + start.size();
    REQUIRE(std::sscanf(text, " x1=\"%lf\" x2=\"%lf\" y1=\"%lf\" y2=\"%lf\"", &line.x1, &line.x2,
                        &line.y1, &line.y2) == 4);
    lines.push_back(line);
  }
  return lines;
}

}  // namespace

TEST_CASE("the page holds the figures, the tables and the charts") {
  const std::string page = report_html(full_data());
  for (const char* part :
       {"<title>kitchen</title>", "geometric predictor", "10.1 mm", "100 keyframes", "sim3",
        "From above", "Position over time", "Error over time", "Scale over time", "two_view",
        "<td>99</td><td>0.25</td><td>0.50</td><td>1.12</td>", "12.4 MB", "3 frames unreadable",
        "RMSE 0.01 m", "ground truth", "x (m)", "time (s)"}) {
    CAPTURE(part);
    CHECK(contains(page, part));
  }
  CHECK(count(page, "<svg class=\"chart\"") == 5);
  CHECK(count(page, "<svg class=\"view\"") == 1);
}

TEST_CASE("the page refers to nothing outside itself") {
  const std::string page = report_html(full_data());
  for (const char* part : {"http:", "https:", "src=", "href=", "@import", "<link", "<iframe"}) {
    CAPTURE(part);
    CHECK_FALSE(contains(page, part));
  }
  CHECK(count(page, "url(") == count(page, "url(#"));
}

TEST_CASE("names are shown, not run") {
  ReportData data = full_data();
  const std::string evil = "<script>alert('1')</script> & \"two\"";
  data.title = evil;
  data.subtitle = evil;
  data.footer = evil;
  data.length_unit = evil;
  data.figures = {{evil, evil, evil}};
  data.protocol = {{evil, evil}};
  data.memory = {{evil, evil}};
  data.timing[0].stage = evil;
  data.warnings = {evil};
  const std::string page = report_html(data);
  CHECK_FALSE(contains(page, "<script>alert"));
  CHECK_FALSE(contains(page, "\"two\""));
  CHECK(contains(page, "&lt;script&gt;alert(&#39;1&#39;)&lt;/script&gt; &amp; &quot;two&quot;"));
  CHECK(count(page, "<script>") == 1);
}

TEST_CASE("without ground truth the page shows the trajectory alone") {
  ReportData data = full_data();
  data.truth.clear();
  data.error.clear();
  data.live_error.clear();
  data.scale.clear();
  data.length_unit.clear();
  const std::string page = report_html(data);
  CHECK(contains(page, "From above"));
  CHECK(contains(page, "map unit"));
  CHECK_FALSE(contains(page, "Error over time"));
  CHECK_FALSE(contains(page, "Scale over time"));
  CHECK_FALSE(contains(page, "ground truth"));
}

TEST_CASE("segments are drawn apart and named") {
  ReportData data = full_data();
  data.truth.clear();
  for (size_t k = 20; k < data.estimate.size(); ++k) data.estimate[k].segment = 1;
  const std::string page = report_html(data);
  CHECK(contains(page, "line estimate segment0"));
  CHECK(contains(page, "line estimate segment1"));
  CHECK(contains(page, "segment 2"));
  CHECK(contains(page, "no common frame or scale"));
}

TEST_CASE("a page of nothing is still a page") {
  const std::string page = report_html({});
  CHECK(contains(page, "<!DOCTYPE html>"));
  CHECK(contains(page, "</html>"));
  CHECK_FALSE(contains(page, "<svg"));
}

TEST_CASE("values that are no numbers leave gaps") {
  ReportData data = full_data();
  data.error[10].value = std::numeric_limits<double>::quiet_NaN();
  data.scale[10].value = std::numeric_limits<double>::infinity();
  data.estimate[10].x = std::numeric_limits<double>::quiet_NaN();
  const std::string page = report_html(data);
  CHECK_FALSE(has_broken_number(page));
}

TEST_CASE("one pose and a camera at rest make a page without broken numbers") {
  ReportData data = full_data();
  data.estimate.resize(1);
  data.live.clear();
  data.truth.clear();
  data.error.assign(1, {data.estimate[0].time_s, 0.0, 0});
  const std::string page = report_html(data);
  CHECK_FALSE(has_broken_number(page));
}

TEST_CASE("the view from above drops the axis with the least motion and keeps the aspect") {
  const ReportData data = full_data();
  CHECK(view_axis(data) == 1);
  std::vector<double> across;
  std::vector<double> up;
  for (const GridLine& line : grid_lines(draw_top_view(data))) {
    if (line.x1 == line.x2) across.push_back(line.x1);
    if (line.y1 == line.y2) up.push_back(line.y1);
  }
  REQUIRE(across.size() >= 3);
  REQUIRE(up.size() >= 3);
  CHECK(std::abs(across[1] - across[0]) == Approx(std::abs(up[1] - up[0])).margin(0.02));
}

TEST_CASE("ground truth of a longer sequence is cut to the time of the run") {
  ReportData data = full_data();
  Point far = data.truth.back();
  far.time_s += 1000.0;
  far.x = 5000.0;
  data.truth.push_back(far);
  CHECK(report_html(data) == report_html(full_data()));
}

TEST_CASE("the same data give the same bytes") {
  CHECK(report_html(full_data()) == report_html(full_data()));
}
