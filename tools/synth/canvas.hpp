// SPDX-License-Identifier: MIT
// A surface to paint on, in metres, with edges smoothed over one texel.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

namespace unisim::synth {

/// RGB, 0..255, not clamped.
using Color = Eigen::Vector3f;

/// Axis-aligned part of a surface: left, top, width, height in metres.
struct Rect {
  double x = 0;
  double y = 0;
  double width = 0;
  double height = 0;

  double center_x() const { return x + width / 2; }
  double center_y() const { return y + height / 2; }
  Rect inset(double margin) const {
    return {x + margin, y + margin, width - 2 * margin, height - 2 * margin};
  }
};

/// Signed distance to a box centred at the origin, < 0 inside.
inline double box_distance(double x, double y, double half_width, double half_height) {
  return std::max(std::abs(x) - half_width, std::abs(y) - half_height);
}

class Canvas {
 public:
  /// @param texel  metres per texel
  Canvas(double width, double height, double texel)
      : columns_(std::max(1, static_cast<int>(std::ceil(width / texel)))),
        rows_(std::max(1, static_cast<int>(std::ceil(height / texel)))),
        texel_x_(width / columns_),
        texel_y_(height / rows_),
        area_{0, 0, width, height},
        texels_(static_cast<size_t>(columns_) * static_cast<size_t>(rows_), Color::Zero()) {}

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  const Rect& area() const { return area_; }
  const Color& at(int column, int row) const { return texels_[index(column, row)]; }

  /// Blend shade(x, y) into the texels of `bounds` where distance(x, y) < 0; the outermost half
  /// texel on either side of distance 0 is blended in proportion.
  template <typename Distance, typename Shade>
  void paint(const Rect& bounds, Distance distance, Shade shade) {
    const int first_column = std::max(0, static_cast<int>(std::floor(bounds.x / texel_x_)));
    const int first_row = std::max(0, static_cast<int>(std::floor(bounds.y / texel_y_)));
    const int last_column =
        std::min(columns_ - 1, static_cast<int>(std::ceil((bounds.x + bounds.width) / texel_x_)));
    const int last_row =
        std::min(rows_ - 1, static_cast<int>(std::ceil((bounds.y + bounds.height) / texel_y_)));
    for (int row = first_row; row <= last_row; ++row) {
      for (int column = first_column; column <= last_column; ++column) {
        const double x = (column + 0.5) * texel_x_;
        const double y = (row + 0.5) * texel_y_;
        const double coverage = std::clamp(0.5 - distance(x, y) / texel_x_, 0.0, 1.0);
        if (coverage > 0) {
          Color& texel = texels_[index(column, row)];
          texel += static_cast<float>(coverage) * (shade(x, y) - texel);
        }
      }
    }
  }

  /// Paint every texel.
  template <typename Shade>
  void fill(Shade shade) {
    paint(area_, [](double, double) { return -1.0; }, shade);
  }

  /// Multiply every texel by factor(x, y).
  template <typename Factor>
  void shade(Factor factor) {
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column) {
        texels_[index(column, row)] *= factor((column + 0.5) * texel_x_, (row + 0.5) * texel_y_);
      }
    }
  }

  void paint_rect(const Rect& rect, const Color& color) {
    paint(
        rect,
        [&rect](double x, double y) {
          return box_distance(x - rect.center_x(), y - rect.center_y(), rect.width / 2,
                              rect.height / 2);
        },
        [&color](double, double) { return color; });
  }

 private:
  size_t index(int column, int row) const {
    return static_cast<size_t>(row) * static_cast<size_t>(columns_) + static_cast<size_t>(column);
  }

  int columns_;
  int rows_;
  double texel_x_;
  double texel_y_;
  Rect area_;
  std::vector<Color> texels_;
};

}  // namespace unisim::synth
