// SPDX-License-Identifier: MIT
// The fused point cloud of a run.
#include "tools/replay/cloud.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>

#include "drivers/geometric/geometric.h"

namespace unisim::replay {
namespace {

bool measured(const unisim_depth_map& map, size_t pixel) {
  return std::isfinite(map.depth[pixel]) && map.depth[pixel] > 0.0F;
}

float confidence_of(const unisim_depth_map& map, size_t pixel) {
  return map.confidence != nullptr ? map.confidence[pixel] : 1.0F;
}

size_t pixel_at(const unisim_depth_map& map, int x, int y) {
  return static_cast<size_t>(y) * static_cast<size_t>(map.width) + static_cast<size_t>(x);
}

/// Every step-th pixel of a map is kept, so that it is at most `columns` wide.
int step_of(const unisim_depth_map& map, int columns) {
  return std::max(1, (map.width + columns - 1) / columns);
}

double mean_confidence(const unisim_depth_map& map) {
  const size_t pixels = static_cast<size_t>(map.width) * static_cast<size_t>(map.height);
  double sum = 0.0;
  size_t count = 0;
  for (size_t pixel = 0; pixel < pixels; ++pixel) {
    if (!measured(map, pixel)) continue;
    sum += static_cast<double>(confidence_of(map, pixel));
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

/// Mean of every second pixel of a box, as red green blue.
std::array<uint8_t, 3> mean_colour(const unisim_image& image, int x0, int x1, int y0, int y1) {
  std::array<int, 3> sum{};
  int count = 0;
  for (int y = y0; y < y1; y += 2) {
    const uint8_t* row = image.data + static_cast<ptrdiff_t>(y) * image.stride;
    for (int x = x0; x < x1; x += 2) {
      const uint8_t* pixel = row + static_cast<ptrdiff_t>(x) * image.format;
      for (size_t c = 0; c < 3; ++c) sum[c] += pixel[image.format == UNISIM_PIXEL_BGR8 ? 2 - c : 0];
      ++count;
    }
  }
  std::array<uint8_t, 3> mean{};
  for (size_t c = 0; c < 3; ++c) mean[c] = static_cast<uint8_t>(sum[c] / std::max(count, 1));
  return mean;
}

/// Segment with the most keyframes that have a pose.
int32_t longest_segment(const std::vector<KeyframeRow>& rows) {
  std::map<int32_t, int> lengths;
  for (const KeyframeRow& row : rows) lengths[row.pose.segment] += row.pose.confidence > 0 ? 1 : 0;
  const auto longest =
      std::max_element(lengths.begin(), lengths.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  return longest != lengths.end() ? longest->first : 0;
}

/// q p q^-1 for a unit quaternion x y z w.
std::array<double, 3> rotate(const double q[4], const std::array<double, 3>& p) {
  const std::array<double, 3> t = {2 * (q[1] * p[2] - q[2] * p[1]), 2 * (q[2] * p[0] - q[0] * p[2]),
                                   2 * (q[0] * p[1] - q[1] * p[0])};
  return {p[0] + q[3] * t[0] + q[1] * t[2] - q[2] * t[1],
          p[1] + q[3] * t[1] + q[2] * t[0] - q[0] * t[2],
          p[2] + q[3] * t[2] + q[0] * t[1] - q[1] * t[0]};
}

/// Puts points in an order in which any first part of them is an even choice: sixteen of these, one
/// after the other, each in the order of before, which is that of neighbours in space. Other views
/// begin elsewhere: of one surface all is seen.
template <class Point>
void spread_evenly(int32_t view, std::vector<Point>* points) {
  constexpr uint32_t kGolden = 0x9e3779b9;  // the golden section of 2^32
  constexpr int kPartBits = 4;
  std::vector<uint8_t> part_of;
  part_of.reserve(points->size());
  for (size_t k = 0; k < points->size(); ++k) {
    const auto turn = kGolden * (static_cast<uint32_t>(k) + static_cast<uint32_t>(view));
    part_of.push_back(static_cast<uint8_t>(turn >> (32 - kPartBits)));
  }
  std::vector<Point> spread;
  spread.reserve(points->size());
  for (int part = 0; part < 1 << kPartBits; ++part) {
    for (size_t k = 0; k < points->size(); ++k) {
      if (part_of[k] == part) spread.push_back((*points)[k]);
    }
  }
  points->swap(spread);
}

size_t share_of(int64_t count, double share) {
  return static_cast<size_t>(std::ceil(share * static_cast<double>(count)));
}

template <class T>
void put(std::string* bytes, const T& value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes->append(raw, sizeof value);
}

void put_vertex(const std::array<double, 3>& position, const std::array<uint8_t, 3>& colour,
                float confidence, std::ostream* file) {
  std::string bytes;
  for (const double value : position) put(&bytes, static_cast<float>(value));
  for (const uint8_t channel : colour) put(&bytes, channel);
  put(&bytes, confidence);
  *file << bytes;
}

std::string ply_header(int64_t points, int32_t segment) {
  std::ostringstream text;
  text << "ply\nformat binary_little_endian 1.0\n"
       << "comment libunisim map, segment " << segment << ", frame and scale of trajectory.tum\n"
       << "element vertex " << points << "\n"
       << "property float x\nproperty float y\nproperty float z\n"
       << "property uchar red\nproperty uchar green\nproperty uchar blue\n"
       << "property float confidence\nend_header\n";
  return text.str();
}

}  // namespace

void Cloud::on_keyframe(int32_t id, const unisim_frame& frame) {
  while (!views_.empty() && views_.begin()->first <= id - kViewsInMemory) settle(views_.begin());
  View& view = views_[id];
  unisim_image image = frame.image;
  if (options_.predictor != nullptr) {
    unisim_geometric_view(options_.predictor, &frame.image, &image);
  }
  view.width = image.width > 0 ? image.width : options_.image_width;
  view.height = image.height > 0 ? image.height : options_.image_height;
  if (image.data == nullptr || image.width <= 0 || image.height <= 0) return;
  view.columns = std::min(kGridWidth, static_cast<int>(image.width));
  view.rows = std::max(1, view.columns * image.height / image.width);
  view.colours.clear();
  for (int row = 0; row < view.rows; ++row) {
    for (int column = 0; column < view.columns; ++column) {
      const int x0 = column * image.width / view.columns;
      const int x1 = (column + 1) * image.width / view.columns;
      const int y0 = row * image.height / view.rows;
      const int y1 = (row + 1) * image.height / view.rows;
      view.colours.push_back(mean_colour(image, x0, x1, y0, y1));
    }
  }
}

void Cloud::on_window(int32_t submap_id, const unisim_window_prediction& window) {
  if (window.focal_px <= 0.0) return;
  for (int32_t k = 0; k < window.count; ++k) {
    const auto found = views_.find(window.keyframe_ids[k]);
    if (found == views_.end() || found->second.width <= 0.0) continue;
    View& view = found->second;
    const double sigma =
        window.center_sigma > 0.0 ? window.center_sigma : std::numeric_limits<double>::infinity();
    const double confidence = mean_confidence(window.depth[k]);
    const bool better = view.submap_id < 0 || sigma < view.center_sigma ||
                        (sigma == view.center_sigma && confidence > view.mean_confidence);
    if (!better) continue;
    view.submap_id = submap_id;
    view.index = k;
    view.center_sigma = sigma;
    view.mean_confidence = confidence;
    view.focal_px = window.focal_px;
    take_depth(window.keyframe_ids[k], window.depth[k], window.focal_px, &view);
  }
}

float Cloud::least_confidence(const unisim_depth_map& map, int step) const {
  std::vector<float> confidences;
  for (int y = step / 2; y < map.height; y += step) {
    for (int x = step / 2; x < map.width; x += step) {
      const size_t pixel = pixel_at(map, x, y);
      if (measured(map, pixel)) confidences.push_back(confidence_of(map, pixel));
    }
  }
  const auto least = static_cast<float>(options_.min_confidence);
  if (confidences.empty()) return least;
  const auto drop =
      static_cast<ptrdiff_t>(options_.confidence_drop * static_cast<double>(confidences.size()));
  std::nth_element(confidences.begin(), confidences.begin() + drop, confidences.end());
  return std::max(least, confidences[static_cast<size_t>(drop)]);
}

void Cloud::take_depth(int32_t id, const unisim_depth_map& given, double focal_px, View* view) {
  view->points.clear();
  const bool fit = options_.sure_confidence > 0.0 && given.confidence != nullptr;
  const unisim_depth_map& map =
      fit ? surface_.fill(given, static_cast<float>(options_.sure_confidence),
                          colours_of(*view, given))
          : given;
  const int step = step_of(map, kGridWidth);
  const float least = least_confidence(map, step);
  for (int row = step / 2; row < map.height; row += step) {
    for (int column = step / 2; column < map.width; column += step) {
      const size_t pixel = pixel_at(map, column, row);
      const float confidence = confidence_of(map, pixel);
      if (!measured(map, pixel) || confidence < least) continue;
      // Places in the image as shares of its sides: depth grids have their own pixels.
      const double x = (column + 0.5) / map.width;
      const double y = (row + 0.5) / map.height;
      view->points.push_back({static_cast<float>((x - 0.5) * view->width / focal_px),
                              static_cast<float>((y - 0.5) * view->height / focal_px),
                              map.depth[pixel], confidence, colour_at(*view, x, y)});
    }
  }
  view->points.shrink_to_fit();
  spread_evenly(id, &view->points);
  view->log_depth = 0.0;
  for (const Point& point : view->points)
    view->log_depth += std::log(static_cast<double>(point.depth));
}

Cloud::Rgb Cloud::colour_at(const View& view, double x, double y) {
  if (view.colours.empty()) return {128, 128, 128};
  const int column = std::min(static_cast<int>(x * view.columns), view.columns - 1);
  const int row = std::min(static_cast<int>(y * view.rows), view.rows - 1);
  const auto at = static_cast<size_t>(row) * static_cast<size_t>(view.columns);
  return view.colours[at + static_cast<size_t>(column)];
}

std::vector<Cloud::Rgb> Cloud::colours_of(const View& view, const unisim_depth_map& map) {
  std::vector<Rgb> colours;
  if (view.colours.empty()) return colours;
  colours.reserve(static_cast<size_t>(map.width) * static_cast<size_t>(map.height));
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column)
      colours.push_back(colour_at(view, (column + 0.5) / map.width, (row + 0.5) / map.height));
  }
  return colours;
}

void Cloud::on_revision(int32_t submap_id, const unisim_window_revision& revision) {
  for (auto& [id, view] : views_) {
    if (view.submap_id != submap_id || view.index >= revision.count) continue;
    const double log_ratio = revision.log_depth_ratio[view.index];
    const double ratio = std::exp(log_ratio);
    view.log_depth += log_ratio * static_cast<double>(view.points.size());
    for (Point& point : view.points) {
      point.depth = static_cast<float>(static_cast<double>(point.depth) * ratio);
    }
    if (revision.center_sigma > 0.0) view.center_sigma = revision.center_sigma;
  }
}

/// The session measures a keyframe that has left its window no more.
void Cloud::on_retired(const unisim_retired& retired, const unisim_pose* /*pose*/) {
  const auto view = views_.find(retired.keyframe_id);
  if (view != views_.end()) settle(view);
}

void Cloud::settle(std::map<int32_t, View>::iterator view) {
  const std::vector<Point>& points = view->second.points;
  if (!points.empty()) {
    const SettledView head = {view->first, view->second.submap_id,
                              static_cast<int64_t>(points.size()), view->second.focal_px,
                              view->second.log_depth};
    settled_.write(settled_.size(), &head, sizeof head);
    settled_.write(settled_.size(), points.data(), points.size() * sizeof(Point));
  }
  views_.erase(view);
}

/// Calls each(placed) for the views of a segment that have a pose, with a share of their points.
template <typename Each>
void Cloud::for_each_placed(const RunData& poses, int32_t segment, double share, Each each) const {
  const auto place = [&](int32_t keyframe_id, int32_t submap_id, PlacedView* placed) {
    const auto row =
        std::lower_bound(poses.keyframes.begin(), poses.keyframes.end(), keyframe_id,
                         [](const KeyframeRow& a, int32_t id) { return a.pose.keyframe_id < id; });
    if (row == poses.keyframes.end() || row->pose.keyframe_id != keyframe_id) return false;
    if (row->pose.confidence == 0 || row->pose.segment != segment) return false;
    const auto submap = static_cast<size_t>(submap_id);
    if (submap_id < 0 || submap >= poses.submap_scale.size()) return false;
    placed->pose = &row->pose;
    placed->scale = poses.submap_scale[submap];
    return placed->scale > 0.0;
  };
  PlacedView placed{};
  std::vector<Point> points;
  SettledView head{};
  for (int64_t at = 0; settled_.read(at, &head, sizeof head);) {
    points.resize(share_of(head.points, share));
    placed.points = points.data();
    placed.count = head.points;
    placed.log_depth = head.log_depth;
    placed.focal_px = head.focal_px;
    if (place(head.keyframe_id, head.submap_id, &placed)) {
      settled_.read(at + int64_t{sizeof head}, points.data(), points.size() * sizeof(Point));
      each(placed);
    }
    at += static_cast<int64_t>(sizeof head) + head.points * static_cast<int64_t>(sizeof(Point));
  }
  for (const auto& [id, view] : views_) {
    placed.points = view.points.data();
    placed.count = static_cast<int64_t>(view.points.size());
    placed.log_depth = view.log_depth;
    placed.focal_px = view.focal_px;
    if (place(id, view.submap_id, &placed)) each(placed);
  }
}

/// Calls each(position in the world, point) for a share of the points of a view.
template <typename Each>
void Cloud::for_each_point(const PlacedView& placed, double share, const CloudCamera& camera,
                           Each each) const {
  const unisim_sim3& T_world_kf = placed.pose->T_world_kf;
  const bool shared = options_.one_camera && camera.focal_px > 0.0;
  const double wider = shared ? placed.focal_px / camera.focal_px : 1.0;
  const double right = shared ? camera.center_x_px / camera.focal_px : 0.0;
  const double down = shared ? camera.center_y_px / camera.focal_px : 0.0;
  const size_t count = share_of(placed.count, share);
  for (const Point* at = placed.points; at != placed.points + count; ++at) {
    const Point& point = *at;
    const double x = static_cast<double>(point.x) * wider - right;
    const double y = static_cast<double>(point.y) * wider - down;
    const double z = static_cast<double>(point.depth) * placed.scale;
    const double side = (1.0 + camera.radial_k1 * (x * x + y * y)) * z;
    std::array<double, 3> world = rotate(T_world_kf.q, {x * side, y * side, z});
    for (size_t axis = 0; axis < 3; ++axis) world[axis] += T_world_kf.t[axis];
    each(world, point);
  }
}

tools::VoxelGrid Cloud::thinned(const RunData& poses, int32_t segment,
                                const CloudCamera& camera) const {
  double log_depth = 0.0;
  int64_t count = 0;
  for_each_placed(poses, segment, 0.0, [&](const PlacedView& placed) {
    log_depth += placed.log_depth + static_cast<double>(placed.count) * std::log(placed.scale);
    count += placed.count;
  });
  const double mean = count > 0 ? std::exp(log_depth / static_cast<double>(count)) : 1.0;
  const int64_t most = options_.most_points;
  const double share = static_cast<double>(most) / static_cast<double>(std::max(count, most));
  tools::VoxelGrid grid(options_.voxel * mean, kMostVoxels,
                        static_cast<size_t>(std::min(count, most)));
  for_each_placed(poses, segment, share, [&](const PlacedView& placed) {
    for_each_point(placed, share, camera,
                   [&](const std::array<double, 3>& world, const Point& point) {
                     std::array<double, 3> colour{};
                     for (size_t i = 0; i < 3; ++i) colour[i] = point.colour[i];
                     const auto confidence = static_cast<double>(point.confidence);
                     // Confidences of any scale: none may weigh nothing, or all.
                     grid.add(world, colour, confidence, std::clamp(confidence, 1e-3, 1e3));
                   });
  });
  return grid;
}

int64_t Cloud::write(const std::filesystem::path& path, const RunData& poses,
                     const CloudCamera& camera) const {
  const int32_t segment = longest_segment(poses.keyframes);
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  int64_t count = 0;
  if (options_.voxel > 0.0) {
    const tools::VoxelGrid grid = thinned(poses, segment, camera);
    count = static_cast<int64_t>(grid.size());
    file << ply_header(count, segment);
    for (size_t k = 0; k < grid.size(); ++k) {
      const tools::VoxelPoint point = grid.point(k);
      Rgb colour{};
      for (size_t i = 0; i < 3; ++i) colour[i] = static_cast<uint8_t>(point.colour[i] + 0.5);
      put_vertex(point.position, colour, static_cast<float>(point.confidence), &file);
    }
  } else {
    for_each_placed(poses, segment, 0.0, [&](const PlacedView& placed) { count += placed.count; });
    file << ply_header(count, segment);
    for_each_placed(poses, segment, 1.0, [&](const PlacedView& placed) {
      for_each_point(placed, 1.0, camera,
                     [&](const std::array<double, 3>& world, const Point& point) {
                       put_vertex(world, point.colour, point.confidence, &file);
                     });
    });
  }
  file.close();
  if (!file)
    throw std::runtime_error(path.string() + ": cannot be written: " + std::strerror(errno));
  return count;
}

}  // namespace unisim::replay
