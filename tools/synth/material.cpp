// SPDX-License-Identifier: MIT
// Surfaces: plaster, wood, tiles, carpet, cardboard, window, door.
#include "tools/synth/material.hpp"

#include "tools/synth/noise.hpp"
#include "tools/synth/random.hpp"

namespace unisim::synth {
namespace {

/// Octaves from 1 m to about 4 mm.
constexpr int kSurfaceOctaves = 9;

float surface_noise(double x, double y, uint64_t seed, float gain) {
  return fractal_noise(static_cast<float>(x), static_cast<float>(y), seed, kSurfaceOctaves, gain);
}

}  // namespace

void paint_plaster(Canvas* canvas, const Color& base, float contrast, uint64_t seed) {
  const Color tint(1.0f, 0.96f, 0.9f);
  canvas->fill([&](double x, double y) -> Color {
    return base + contrast * surface_noise(x, y, seed, 0.86f) * tint;
  });
}

void paint_planks(Canvas* canvas, double board_width, const Color& base, uint64_t seed) {
  const double board_length = board_width * 9;
  canvas->fill([&](double x, double y) -> Color {
    const double board = std::floor(y / board_width);
    const uint64_t row_seed = derive_seed(seed, static_cast<uint64_t>(board));
    const double along = x + static_cast<double>(row_seed % 1000) * 0.001 * board_length;
    const double piece = std::floor(along / board_length);
    Random random(derive_seed(row_seed, static_cast<uint64_t>(piece)));
    const auto shade = static_cast<float>(random.uniform(0.7, 1.15));
    // Grain: noise stretched along the board.
    const float grain = surface_noise(along * 0.6 + random.uniform(0, 50), y * 6, row_seed, 0.75f);
    const double to_side = board_width / 2 - std::abs(y - (board + 0.5) * board_width);
    const double to_end = board_length / 2 - std::abs(along - (piece + 0.5) * board_length);
    const auto gap =
        static_cast<float>(std::clamp(std::min(to_side, to_end) / 0.003 - 0.2, 0.35, 1.0));
    return (base * shade * (1.0f + 0.35f * grain)) * gap;
  });
}

void paint_tiles(Canvas* canvas, double tile, const Color& base, uint64_t seed) {
  canvas->fill([&](double x, double y) -> Color {
    const double i = std::floor(x / tile);
    const double j = std::floor(y / tile);
    Random random(
        derive_seed(derive_seed(seed, static_cast<uint64_t>(i)), static_cast<uint64_t>(j)));
    const auto shade = static_cast<float>(random.uniform(0.62, 1.15));
    const double to_edge = std::min(tile / 2 - std::abs(x - (i + 0.5) * tile),
                                    tile / 2 - std::abs(y - (j + 0.5) * tile));
    const auto joint = static_cast<float>(std::clamp(to_edge / 0.004 - 0.3, 0.45, 1.0));
    const float marble = surface_noise(x * 1.7 + random.uniform(0, 9), y * 1.7, seed, 0.7f);
    return base * shade * joint * (1.0f + 0.22f * marble);
  });
}

void paint_carpet(Canvas* canvas, const Rect& rect, uint64_t seed) {
  Random random(seed);
  const Color ground(110, 52, 48);
  const Color pattern(196, 160, 104);
  const double block = 0.16;
  const auto distance = [&rect](double x, double y) {
    return box_distance(x - rect.center_x(), y - rect.center_y(), rect.width / 2, rect.height / 2);
  };
  canvas->paint(rect, distance, [&](double x, double y) -> Color {
    const double inside = -distance(x, y);
    const double u = (x - rect.x) / block;
    const double v = (y - rect.y) / block;
    Random cell(derive_seed(
        seed, static_cast<uint64_t>(std::floor(u)) * 1000 + static_cast<uint64_t>(std::floor(v))));
    const double radius = std::abs(u - std::floor(u) - 0.5) + std::abs(v - std::floor(v) - 0.5);
    const bool figure = inside < 0.05 || (inside > 0.08 && radius < cell.uniform(0.15, 0.5));
    const float weave = surface_noise(x * 2, y * 2, seed, 0.85f);
    return (figure ? pattern : ground) * (1.0f + 0.4f * weave);
  });
}

void paint_cardboard(Canvas* canvas, uint64_t seed) {
  Random random(seed);
  const Rect area = canvas->area();
  const Color base(static_cast<float>(random.uniform(150, 190)),
                   static_cast<float>(random.uniform(115, 140)), 92);
  paint_plaster(canvas, base, 34, derive_seed(seed, 1));
  canvas->paint_rect({area.x, area.height * random.uniform(0.4, 0.55), area.width, 0.04},
                     Color(205, 190, 150));
  const Rect label{area.width * random.uniform(0.1, 0.3), area.height * random.uniform(0.1, 0.3),
                   area.width * 0.45, area.height * 0.3};
  canvas->paint_rect(label, Color(232, 230, 222));
  const double line = std::min(0.03, label.height * 0.3);
  paint_text(canvas, label.inset(line * 0.4), line, Color(35, 35, 45), derive_seed(seed, 2));
  paint_text(canvas, {area.width * 0.15, area.height * 0.7, area.width * 0.7, area.height * 0.22},
             std::min(0.06, area.height * 0.2), Color(70, 45, 35), derive_seed(seed, 3));
}

void paint_window(Canvas* canvas, const Rect& rect, uint64_t seed) {
  canvas->paint_rect(rect, Color(225, 222, 214));
  const int columns = 3;
  const int rows = 2;
  const double pane_width = rect.width / columns;
  const double pane_height = rect.height / rows;
  for (int i = 0; i < columns * rows; ++i) {
    const int row = i / columns;
    const Rect pane = Rect{rect.x + (i % columns) * pane_width, rect.y + row * pane_height,
                           pane_width, pane_height}
                          .inset(0.03);
    const auto distance = [&pane](double x, double y) {
      return box_distance(x - pane.center_x(), y - pane.center_y(), pane.width / 2,
                          pane.height / 2);
    };
    canvas->paint(pane, distance, [&](double x, double y) -> Color {
      const auto height = static_cast<float>((y - rect.y) / rect.height);
      const float tree = surface_noise(x * 2.5, y * 2.5, seed, 0.6f);
      const bool leaves = tree > 0.5f - height;
      const Color sky(150 + 40 * height, 180 + 20 * height, 214);
      return leaves ? Color(74 + 60 * tree, 104 + 70 * tree, 60 + 30 * tree) : sky;
    });
  }
}

void paint_door(Canvas* canvas, const Rect& rect, uint64_t seed) {
  Random random(seed);
  const Color wood(static_cast<float>(random.uniform(110, 150)),
                   static_cast<float>(random.uniform(78, 105)), 60);
  const auto grained = [&](const Rect& part, float shade) {
    canvas->paint(
        part,
        [&part](double x, double y) {
          return box_distance(x - part.center_x(), y - part.center_y(), part.width / 2,
                              part.height / 2);
        },
        [&, shade](double x, double y) -> Color {
          return wood * shade * (1.0f + 0.3f * surface_noise(x * 7, y * 0.7, seed, 0.75f));
        });
  };
  grained(rect, 0.75f);
  grained(rect.inset(0.05), 1.1f);
  for (int i = 0; i < 4; ++i) {
    const int row = i / 2;
    const Rect panel{rect.x + 0.12 + (i % 2) * (rect.width / 2 - 0.06),
                     rect.y + 0.15 + row * rect.height * 0.5, rect.width / 2 - 0.18,
                     rect.height * 0.5 - 0.28};
    grained(panel, 0.7f);
    grained(panel.inset(0.025), 1.2f);
  }
  canvas->paint_rect({rect.x + rect.width - 0.14, rect.center_y(), 0.11, 0.025},
                     Color(190, 188, 180));
  const Rect sign{rect.center_x() - 0.12, rect.y + rect.height * 0.28, 0.24, 0.14};
  canvas->paint_rect(sign, Color(236, 236, 230));
  paint_text(canvas, sign.inset(0.015), 0.035, Color(30, 40, 90), derive_seed(seed, 4));
}

}  // namespace unisim::synth
