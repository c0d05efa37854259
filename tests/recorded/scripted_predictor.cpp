// SPDX-License-Identifier: MIT
// A predictor whose every answer follows from the numbers asked for.
#include "tests/recorded/scripted_predictor.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace unisim::test {
namespace {

constexpr int kPixels = kScriptedDepthWidth * kScriptedDepthHeight;
using Pixels = std::array<float, kPixels>;

struct Scripted : unisim_predictor {
  int64_t frame = -1;
  int32_t newest = -1;
  bool finished = false;
  std::vector<int32_t> ids;
  std::vector<unisim_sim3> poses;
  std::vector<double> ratios;
  std::vector<Pixels> depth;
  std::vector<Pixels> confidence;
  std::vector<unisim_depth_map> maps;
  std::vector<int64_t> to_revise;
  int32_t wide_for = -1;  // newest keyframe when the last wide window was given
  std::string text;
};

Scripted& self(unisim_predictor* predictor) { return *static_cast<Scripted*>(predictor); }

unisim_sim3 pose_of(double seed) {
  const double angle = 0.1 * std::sin(seed);
  return {{0.0, std::sin(angle), 0.0, std::cos(angle)}, {seed / 3.0, -seed / 7.0, 1.0 / seed}, 1.0};
}

/// Depth with a missing (NaN) pixel; a map of an even seed has no confidence.
void fill_maps(Scripted& scripted, const std::vector<double>& seeds) {
  scripted.depth.resize(seeds.size());
  scripted.confidence.resize(seeds.size());
  scripted.maps.clear();
  for (size_t view = 0; view < seeds.size(); ++view) {
    for (int k = 0; k < kPixels; ++k) {
      const auto at = static_cast<size_t>(k);
      scripted.depth[view][at] = static_cast<float>(1.0 / 3.0 + seeds[view] + 0.01 * k);
      scripted.confidence[view][at] = static_cast<float>(std::cos(seeds[view] + k));
    }
    scripted.depth[view][4] = std::numeric_limits<float>::quiet_NaN();
    const bool even = static_cast<int>(seeds[view]) % 2 == 0;
    scripted.maps.push_back({scripted.depth[view].data(),
                             even ? nullptr : scripted.confidence[view].data(), kScriptedDepthWidth,
                             kScriptedDepthHeight});
  }
}

int observe(unisim_predictor* predictor, const unisim_frame* frame, unisim_motion* motion) {
  Scripted& scripted = self(predictor);
  scripted.frame = frame->index;
  *motion = {0.01 / (1.0 + static_cast<double>(frame->index)), 0.7, 0,
             frame->index % 4 == 3 ? UNISIM_REASON_BLUR : UNISIM_REASON_NONE};
  if (frame->index != 5) return UNISIM_PREDICTION_OK;
  scripted.text = "frame 5 is black";
  return UNISIM_PREDICTION_REJECTED;
}

int keyframe(unisim_predictor* predictor, const unisim_frame*, int32_t id) {
  self(predictor).newest = id;
  return UNISIM_PREDICTION_OK;
}

int two_view(unisim_predictor* predictor, int32_t i, int32_t j, unisim_pair_prediction* out) {
  Scripted& scripted = self(predictor);
  if (scripted.newest < 2) return UNISIM_PREDICTION_PENDING;
  if (i == 4) {
    scripted.text = "pair 4,5: turned on the spot";
    return UNISIM_PREDICTION_REJECTED;
  }
  fill_maps(scripted, {static_cast<double>(i), static_cast<double>(j)});
  const double focal = 500.0 + scripted.newest / 3.0;
  *out = {pose_of(j),
          scripted.maps[0],
          scripted.maps[1],
          focal,
          0.001 * j,
          i == 6 ? 2 : 0,
          0,
          i == 6 || i == 8 ? 0.1 * i : 0.0};
  return UNISIM_PREDICTION_OK;
}

int multi_view(unisim_predictor* predictor, const int32_t* ids, int32_t count,
               unisim_window_prediction* out) {
  Scripted& scripted = self(predictor);
  const int32_t last = ids[count - 1];
  if (last == 7) {
    scripted.text = "window lost its views";
    return UNISIM_PREDICTION_REJECTED;
  }
  if (last == scripted.newest && !scripted.finished) return UNISIM_PREDICTION_PENDING;
  scripted.ids.assign(ids + 1, ids + count);
  std::vector<double> seeds(scripted.ids.begin(), scripted.ids.end());
  scripted.poses.clear();
  for (double seed : seeds) scripted.poses.push_back(pose_of(seed));
  fill_maps(scripted, seeds);
  scripted.to_revise.push_back(last);
  *out = {count - 1,
          scripted.ids.data(),
          scripted.poses.data(),
          scripted.maps.data(),
          501.25,
          1.0 / 1024.0,
          100 + last,
          nullptr,
          last % 2 == 0 ? 1.0 / 3.0 : 0.0,  // every other one in metres
          last % 2 == 0 ? 0.1 : 0.0,
          last % 2 == 0 ? 0.05 : 0.0};
  return UNISIM_PREDICTION_OK;
}

int next_revision(unisim_predictor* predictor, unisim_window_revision* out) {
  Scripted& scripted = self(predictor);
  for (size_t k = 0; k < scripted.to_revise.size(); ++k) {
    const int64_t last = scripted.to_revise[k];
    if (last + 2 > scripted.newest && !scripted.finished) continue;
    scripted.to_revise.erase(scripted.to_revise.begin() + static_cast<std::ptrdiff_t>(k));
    scripted.poses = {pose_of(2.0 + static_cast<double>(last)), pose_of(3.0)};
    scripted.ratios = {0.125, -1.0 / 3.0};
    *out = {100 + last, 2, scripted.poses.data(), scripted.ratios.data(), 0.002, 1, 0};
    return UNISIM_PREDICTION_OK;
  }
  return UNISIM_PREDICTION_PENDING;
}

/// One with every third keyframe.
int next_wide_window(unisim_predictor* predictor, int32_t, unisim_window_prediction* out) {
  Scripted& scripted = self(predictor);
  const int32_t newest = scripted.newest;
  if (newest < 3 || newest % 3 != 0 || newest == scripted.wide_for)
    return UNISIM_PREDICTION_PENDING;
  scripted.wide_for = newest;
  scripted.ids = {0, newest / 2, newest};
  scripted.poses = {pose_of(1.0), pose_of(5.0), pose_of(7.0 + newest)};
  fill_maps(scripted, {3.0, 4.0, static_cast<double>(newest)});
  *out = {3,
          scripted.ids.data(),
          scripted.poses.data(),
          scripted.maps.data(),
          501.5,
          0.003,
          -1,
          nullptr,
          0.0,
          0.0,
          0.0};
  return UNISIM_PREDICTION_OK;
}

int frame_pose(unisim_predictor* predictor, unisim_frame_pose* out) {
  Scripted& scripted = self(predictor);
  if (scripted.newest < 2) return UNISIM_PREDICTION_PENDING;
  *out = {pose_of(1.0 + static_cast<double>(scripted.frame)), scripted.newest};
  return UNISIM_PREDICTION_OK;
}

int finish(unisim_predictor* predictor) {
  self(predictor).finished = true;
  return UNISIM_PREDICTION_OK;
}

void info(unisim_predictor*, unisim_predictor_info* out) {
  *out = {525.5, 1.0 / 3.0, -0.033, 4096, 1, 2,   3,     4, nullptr, nullptr,
          0,     0,         0,      0,    0, 2.5, -1.25, 0, 0,       0};
}

const char* message(unisim_predictor* predictor) { return self(predictor).text.c_str(); }

void destroy(unisim_predictor* predictor) { delete &self(predictor); }

}  // namespace

unisim_predictor* make_scripted_predictor() {
  auto* scripted = new Scripted();
  scripted->struct_size = sizeof(unisim_predictor);
  scripted->name = "scripted";
  scripted->needs_images = 1;
  scripted->observe = observe;
  scripted->keyframe = keyframe;
  scripted->two_view = two_view;
  scripted->multi_view = multi_view;
  scripted->next_revision = next_revision;
  scripted->next_wide_window = next_wide_window;
  scripted->frame_pose = frame_pose;
  scripted->finish = finish;
  scripted->info = info;
  scripted->message = message;
  scripted->destroy = destroy;
  return scripted;
}

}  // namespace unisim::test
