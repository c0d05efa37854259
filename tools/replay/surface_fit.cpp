// SPDX-License-Identifier: MIT
// Depth between sparse measured pixels: planes fitted to what lies around.
#include "tools/replay/surface_fit.hpp"

#include <algorithm>
#include <cmath>

namespace unisim::replay {
namespace {

constexpr int kReach = 8;              // pixels
constexpr float kSigma = 3.0F;         // pixels, of nearness
constexpr float kColourSigma = 40.0F;  // levels
constexpr float kLeastColour = 0.1F;   // paint on one surface differs too
constexpr int kRounds = 3;             // of fitting and weighing by residual
constexpr float kResidual = 0.02F;     // of the inverse depth, where weights have halved
constexpr float kLeastWeight = 0.05F;
constexpr size_t kLeastNeighbours = 3;
constexpr float kSlopePrior = 1.0F;  // squared pixels: slopes of few or lined-up points stay small
constexpr float kDisagreement = 10.0F;

constexpr float kMostSpread = 0.25F;  // of a squared relative residual: far is far

float squared(float value) { return value * value; }

}  // namespace

/// Inverse depth as a plane over the image.
struct SurfaceFit::Plane {
  float x;  // weighted mean of the neighbours, from the pixel
  float y;
  float weight;    // of all of them
  float at_pixel;  // inverse depth there
  float slope_x;
  float slope_y;

  float at(const Neighbour& n) const { return at_pixel + slope_x * n.dx + slope_y * n.dy; }
};

/// Weighted least squares about the mean, which no prior pulls at.
bool SurfaceFit::plane_through(const std::vector<Neighbour>& neighbours, Plane* plane) {
  float total = 0.0F, x = 0.0F, y = 0.0F, value = 0.0F;
  for (const Neighbour& n : neighbours) {
    total += n.robust;
    x += n.robust * n.dx;
    y += n.robust * n.dy;
    value += n.robust * n.inverse_depth;
  }
  if (!(total > kLeastWeight)) return false;
  x /= total;
  y /= total;
  value /= total;
  float xx = 0.0F, xy = 0.0F, yy = 0.0F, xv = 0.0F, yv = 0.0F;
  for (const Neighbour& n : neighbours) {
    const float dx = n.dx - x;
    const float dy = n.dy - y;
    const float dv = n.inverse_depth - value;
    xx += n.robust * dx * dx;
    xy += n.robust * dx * dy;
    yy += n.robust * dy * dy;
    xv += n.robust * dx * dv;
    yv += n.robust * dy * dv;
  }
  xx += total * kSlopePrior;
  yy += total * kSlopePrior;
  const float determinant = xx * yy - xy * xy;  // above 0 by the prior
  const float slope_x = (yy * xv - xy * yv) / determinant;
  const float slope_y = (xx * yv - xy * xv) / determinant;
  *plane = {x, y, total, value - slope_x * x - slope_y * y, slope_x, slope_y};
  return plane->at_pixel > 0.0F;
}

void SurfaceFit::gather(const unisim_depth_map& map, float sure, const std::vector<Rgb>& colours) {
  const auto pixels = static_cast<size_t>(map.width) * static_cast<size_t>(map.height);
  samples_.clear();
  sample_at_.assign(pixels, 0);
  depth_.assign(pixels, 0.0F);
  confidence_.assign(pixels, 0.0F);
  for (size_t at = 0; at < pixels; ++at) {
    if (!std::isfinite(map.depth[at]) || map.depth[at] <= 0.0F || map.confidence[at] < sure)
      continue;
    depth_[at] = map.depth[at];
    confidence_[at] = map.confidence[at];
    Sample sample{static_cast<float>(at % static_cast<size_t>(map.width)),
                  static_cast<float>(at / static_cast<size_t>(map.width)),
                  1.0F / map.depth[at],
                  {}};
    if (!colours.empty()) {
      for (size_t i = 0; i < 3; ++i) sample.colour[i] = static_cast<float>(colours[at][i]);
    }
    samples_.push_back(sample);
    sample_at_[at] = static_cast<int32_t>(samples_.size());
  }
}

void SurfaceFit::near(int column, int row, const Rgb* colour) {
  neighbours_.clear();
  for (int y = std::max(0, row - kReach); y <= std::min(filled_.height - 1, row + kReach); ++y) {
    for (int x = std::max(0, column - kReach); x <= std::min(filled_.width - 1, column + kReach);
         ++x) {
      const int32_t at = sample_at_[static_cast<size_t>(y) * static_cast<size_t>(filled_.width) +
                                    static_cast<size_t>(x)];
      if (at == 0) continue;
      const Sample& sample = samples_[static_cast<size_t>(at - 1)];
      const float dx = sample.column - static_cast<float>(column);
      const float dy = sample.row - static_cast<float>(row);
      float weight = std::exp(-(dx * dx + dy * dy) / (2 * squared(kSigma)));
      if (colour != nullptr) {
        float difference = 0.0F;
        for (size_t i = 0; i < 3; ++i)
          difference += squared(sample.colour[i] - static_cast<float>((*colour)[i]));
        weight *=
            kLeastColour + (1 - kLeastColour) * std::exp(-difference / (2 * squared(kColourSigma)));
      }
      neighbours_.push_back({dx, dy, sample.inverse_depth, weight, weight});
    }
  }
}

bool SurfaceFit::fit(float* inverse_depth, float* confidence) {
  if (neighbours_.size() < kLeastNeighbours) return false;
  Plane plane{};
  for (int round = 0; round < kRounds; ++round) {
    if (round > 0) {
      for (Neighbour& n : neighbours_) {
        n.robust = n.weight /
                   (1.0F + squared((n.inverse_depth - plane.at(n)) / (kResidual * plane.at_pixel)));
      }
    }
    if (!plane_through(neighbours_, &plane)) return false;
  }
  float total = 0.0F;
  float spread = 0.0F;
  for (const Neighbour& n : neighbours_) {
    total += n.weight;
    spread +=
        n.weight * std::min(squared((n.inverse_depth - plane.at(n)) / plane.at_pixel), kMostSpread);
  }
  const float aside = (squared(plane.x) + squared(plane.y)) / squared(kSigma);
  *inverse_depth = plane.at_pixel;
  *confidence = kFitted * std::min(1.0F, plane.weight) /
                ((1.0F + kDisagreement * std::sqrt(spread / total)) * (1.0F + aside));
  return true;
}

const unisim_depth_map& SurfaceFit::fill(const unisim_depth_map& map, float sure,
                                         const std::vector<Rgb>& colours) {
  gather(map, sure, colours);
  filled_ = {depth_.data(), confidence_.data(), map.width, map.height};
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      const size_t at =
          static_cast<size_t>(row) * static_cast<size_t>(map.width) + static_cast<size_t>(column);
      if (sample_at_[at] != 0) continue;
      near(column, row, colours.empty() ? nullptr : &colours[at]);
      float inverse_depth = 0.0F;
      if (!fit(&inverse_depth, &confidence_[at])) continue;
      depth_[at] = 1.0F / inverse_depth;
    }
  }
  return filled_;
}

}  // namespace unisim::replay
