// SPDX-License-Identifier: MIT
// A view of the run as events of the page.
#include "tools/live/web/event_text.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "drivers/common/image_mat.hpp"
#include "drivers/pipeline/tracking_reason.hpp"
#include "tools/common/json_text.hpp"
#include "tools/live/figures.hpp"
#include "tools/replay/progress_line.hpp"
#include "tools/replay/version.hpp"

namespace unisim::live::web {
namespace {

using tools::Json;

constexpr int kWidestImage = 640;  // a page is no wider, and a slow network carries it
constexpr int kJpegQuality = 70;
constexpr double kSteps = 4096.0;  // of a map's side: finer than a screen

std::string event(const char* name, const Json& data) {
  return std::string("event: ") + name + "\ndata: " + tools::json_text(data) + "\n\n";
}

/// To `parts` of one; JSON knows no NaN.
double rounded(double value, double parts) {
  return std::isfinite(value) ? std::round(value * parts) / parts : 0.0;
}

Json stages_json(const View& view) {
  Json list = Json::array();
  for (const StageFigures& stage : view.stages) {
    list.push_back({{"name", stage.name},
                    {"count", stage.count},
                    {"p50_ms", rounded(stage.p50_ms, 1000)},
                    {"p95_ms", rounded(stage.p95_ms, 1000)},
                    {"max_ms", rounded(stage.max_ms, 1000)}});
  }
  return list;
}

std::string base64(const std::vector<uint8_t>& bytes) {
  static const char* const kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t k = 0; k < bytes.size(); k += 3) {
    uint32_t three = static_cast<uint32_t>(bytes[k]) << 16;
    if (k + 1 < bytes.size()) three |= static_cast<uint32_t>(bytes[k + 1]) << 8;
    if (k + 2 < bytes.size()) three |= bytes[k + 2];
    for (int shift = 18; shift >= 0; shift -= 6) text += kDigits[(three >> shift) & 63];
    if (k + 1 >= bytes.size()) text[text.size() - 2] = '=';
    if (k + 2 >= bytes.size()) text[text.size() - 1] = '=';
  }
  return text;
}

void encode(const unisim_image& image, std::vector<uint8_t>* jpeg) {
  const cv::Mat whole = drivers::image_mat(image);
  cv::Mat shown = whole;
  if (image.width > kWidestImage) {
    const double scale = static_cast<double>(kWidestImage) / image.width;
    cv::resize(whole, shown, cv::Size(), scale, scale, cv::INTER_AREA);
  }
  cv::imencode(".jpg", shown, *jpeg, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
}

/// Places as whole numbers of steps from the corner of what is shown.
class Grid {
 public:
  void add(const TopView::Place& place) {
    low_across_ = std::min(low_across_, place.across);
    high_across_ = std::max(high_across_, place.across);
    low_ahead_ = std::min(low_ahead_, place.ahead);
    high_ahead_ = std::max(high_ahead_, place.ahead);
  }
  double step() const {
    const double side = std::max(high_across_ - low_across_, high_ahead_ - low_ahead_);
    return side > 0.0 && std::isfinite(side) ? side / kSteps : 1.0;
  }
  Json corner() const {
    return std::isfinite(low_across_) ? Json{low_across_, low_ahead_} : Json{0.0, 0.0};
  }
  void put(const TopView::Place& place, Json* list) const {
    list->push_back(static_cast<int64_t>(std::lround((place.across - low_across_) / step())));
    list->push_back(static_cast<int64_t>(std::lround((place.ahead - low_ahead_) / step())));
  }

 private:
  double low_across_ = INFINITY;
  double high_across_ = -INFINITY;
  double low_ahead_ = INFINITY;
  double high_ahead_ = -INFINITY;
};

std::vector<TopView::Place> places_of(const std::vector<PathPoint>& path, int32_t segment,
                                      const TopView& top) {
  std::vector<TopView::Place> places;
  for (const PathPoint& point : path) {
    const double* t = point.T_world_cam.t;
    if (point.segment == segment) places.push_back(top.place({t[0], t[1], t[2]}));
  }
  return places;
}

std::vector<TopView::Place> places_of(const std::vector<CloudPatch>& cloud, int32_t segment,
                                      const TopView& top) {
  std::vector<TopView::Place> places;
  for (const CloudPatch& patch : cloud) {
    if (patch.segment != segment) continue;
    for (size_t k = 0; k < patch.count; ++k) {
      const float* xyz = &patch.xyz[3 * k];
      places.push_back(top.place(transform(patch.T_world_points, {xyz[0], xyz[1], xyz[2]})));
    }
  }
  return places;
}

/// Points far from all others would make the map a dot. @return across and ahead of the middle 96 %
void drop_far(std::vector<TopView::Place>* places) {
  constexpr double kOutside = 0.02;
  if (places->size() < 50) return;
  const auto part = static_cast<std::ptrdiff_t>(kOutside * static_cast<double>(places->size()));
  for (double TopView::Place::* axis : {&TopView::Place::across, &TopView::Place::ahead}) {
    const auto less = [axis](const TopView::Place& a, const TopView::Place& b) {
      return a.*axis < b.*axis;
    };
    std::sort(places->begin(), places->end(), less);
    places->erase(places->end() - part, places->end());
    places->erase(places->begin(), places->begin() + part);
  }
}

}  // namespace

std::string EventText::status(const View& view, double silent_s) const {
  constexpr double kMega = 1e6;
  const unisim_session_info& session = view.session;
  const double warmest = temperature_c();
  const pipeline::Metre& metre = view.progress.metre;
  return event("status", {{"source", source_},
                          {"version", replay::version_text()},
                          {"state", replay::state_name(view.progress.state)},
                          {"reason", pipeline::reason_name(view.progress.reason)},
                          {"unit", metre.per_unit > 0.0 ? "metric" : "relative"},
                          {"scale_sigma", metre.sigma},
                          {"metres_per_unit", metre.per_unit},
                          {"confidence", view.confidence},
                          {"segment", view.segment},
                          {"map_revision", session.map_revision},
                          {"frames", view.progress.frames},
                          {"frames_bad", view.progress.frames_bad},
                          {"frames_dropped", view.progress.frames_dropped},
                          {"queue_depth", view.progress.frames_waiting},
                          {"keyframes", session.keyframes},
                          {"submaps", session.submaps},
                          {"loops", session.loops},
                          {"lost_events", session.lost_events},
                          {"frames_per_second", rounded(view.frames_per_second, 10)},
                          {"pose_age_p50_ms", rounded(view.age_p50_ms, 10)},
                          {"pose_age_p95_ms", rounded(view.age_p95_ms, 10)},
                          {"pose_age_p99_ms", rounded(view.age_p99_ms, 10)},
                          {"memory_mb", rounded(static_cast<double>(resident_bytes()) / kMega, 10)},
                          {"temperature_c", warmest >= 0.0 ? Json(warmest) : Json(nullptr)},
                          {"silent_s", rounded(silent_s, 10)},
                          {"stages", stages_json(view)},
                          {"messages", view.messages}});
}

std::string EventText::frame(const View& view) {
  encode(view.image, &jpeg_);
  Json features = Json::array();
  for (const unisim_feature& feature : view.features) {
    features.push_back(rounded(feature.x, 2));
    features.push_back(rounded(feature.y, 2));
    features.push_back(feature.placed);
  }
  Json camera = nullptr;
  if (view.posed) {
    const TopView::Place at = top_.place(transform(view.T_world_cam, {0.0, 0.0, 0.0}));
    const TopView::Place front = top_.place(transform(view.T_world_cam, {0.0, 0.0, 1.0}));
    camera = {at.across, at.ahead, front.across - at.across, front.ahead - at.ahead};
  }
  return event("frame", {{"width", view.image.width},
                         {"height", view.image.height},
                         {"features", features},
                         {"camera", camera},
                         {"segment", view.segment},
                         {"jpeg", base64(jpeg_)}});
}

std::string EventText::map(const View& view) {
  top_.fit(view.corrected, view.segment);
  const auto corrected = places_of(view.corrected, view.segment, top_);
  const auto live = places_of(view.live, view.segment, top_);
  std::vector<TopView::Place> cloud = places_of(view.cloud, view.segment, top_);
  drop_far(&cloud);
  Grid grid;
  for (const TopView::Place& place : corrected) grid.add(place);
  for (const TopView::Place& place : live) grid.add(place);
  for (const TopView::Place& place : cloud) grid.add(place);
  const auto list = [&grid](const std::vector<TopView::Place>& places) {
    Json numbers = Json::array();
    for (const TopView::Place& place : places) grid.put(place, &numbers);
    return numbers;
  };
  Json heights = Json::array();
  for (const TopView::Place& place : cloud) {
    heights.push_back(static_cast<int64_t>(std::lround(place.height / grid.step())));
  }
  return event("map", {{"segment", view.segment},
                       {"corner", grid.corner()},
                       {"step", grid.step()},
                       {"corrected", list(corrected)},
                       {"live", list(live)},
                       {"cloud", list(cloud)},
                       {"heights", heights}});
}

}  // namespace unisim::live::web
