// SPDX-License-Identifier: MIT
// A furnished living room; the same room freshly painted white, with little to see.
#include "tools/synth/material.hpp"
#include "tools/synth/random.hpp"
#include "tools/synth/scene.hpp"

namespace unisim::synth {
namespace {

using Eigen::Vector3d;

constexpr double kTexel = 0.0035;

void add_lights(Scene* scene) {
  scene->add_light({{1.2, 0.8, 2.6}, 0.75});
  scene->add_light({{-1.3, -0.7, 2.6}, 0.65});
}

/// Plaster with `count` posters side by side, at varying heights.
Painter poster_wall(const Color& base, int count, uint64_t seed) {
  return [=](Canvas* canvas) {
    Random random(seed);
    paint_plaster(canvas, base, 44, random.next());
    const double slot = canvas->area().width / count;
    for (int i = 0; i < count; ++i) {
      const double width = slot * random.uniform(0.45, 0.8);
      const double height = random.uniform(0.5, 1.0);
      paint_poster(canvas,
                   {i * slot + random.uniform(0.05, slot - width - 0.02), random.uniform(0.3, 0.75),
                    width, height},
                   random.next());
    }
    canvas->paint_rect({0, canvas->area().height - 0.09, canvas->area().width, 0.09},
                       Color(120, 108, 96));
  };
}

Painter window_wall(uint64_t seed) {
  return [=](Canvas* canvas) {
    paint_plaster(canvas, Color(176, 168, 150), 44, seed);
    paint_window(canvas, {0.5, 0.7, 1.7, 1.2}, derive_seed(seed, 1));
    paint_poster(canvas, {2.55, 0.85, 0.8, 1.0}, derive_seed(seed, 2));
  };
}

Painter door_wall(uint64_t seed) {
  return [=](Canvas* canvas) {
    paint_plaster(canvas, Color(150, 160, 168), 44, seed);
    paint_door(canvas, {0.5, canvas->area().height - 2.05, 0.95, 2.05}, derive_seed(seed, 1));
    paint_poster(canvas, {1.75, 0.8, 0.9, 0.7}, derive_seed(seed, 2));
    paint_poster(canvas, {2.9, 1.0, 0.7, 0.95}, derive_seed(seed, 3));
  };
}

std::function<void(Canvas*, int)> bookshelf(uint64_t seed) {
  return [=](Canvas* canvas, int face) {
    const Rect area = canvas->area();
    const uint64_t face_seed = derive_seed(seed, static_cast<uint64_t>(face));
    paint_planks(canvas, 0.3, Color(120, 88, 62), face_seed);
    const int shelves = std::max(1, static_cast<int>(area.height / 0.36));
    if (face >= 4 || area.width < 0.5) {
      return;
    }
    const double pitch = area.height / shelves;
    for (int i = 0; i < shelves; ++i) {
      paint_books(canvas, Rect{0, i * pitch, area.width, pitch}.inset(0.025),
                  derive_seed(face_seed, static_cast<uint64_t>(i)));
    }
  };
}

std::function<void(Canvas*, int)> wooden(double board, const Color& base, uint64_t seed) {
  return [=](Canvas* canvas, int face) {
    paint_planks(canvas, board, base, derive_seed(seed, static_cast<uint64_t>(face)));
  };
}

std::function<void(Canvas*, int)> cardboard(uint64_t seed) {
  return [=](Canvas* canvas, int face) {
    paint_cardboard(canvas, derive_seed(seed, static_cast<uint64_t>(face)));
  };
}

void add_table(Scene* scene, uint64_t seed) {
  scene->add_box({0.1, 0, 0.68}, {1.1, 0.7, 0.05}, 0.15, wooden(0.12, Color(160, 112, 70), seed));
  for (const double x : {-0.45, 0.45}) {
    for (const double y : {-0.27, 0.27}) {
      const Vector3d leg = Eigen::AngleAxisd(0.15, Vector3d::UnitZ()) * Vector3d(x, y, 0);
      scene->add_box(leg + Vector3d(0.1, 0, 0), {0.06, 0.06, 0.68}, 0.15,
                     wooden(0.06, Color(130, 90, 56), seed));
    }
  }
  scene->add_box({0.3, 0.1, 0.73}, {0.24, 0.18, 0.2}, 0.6, cardboard(derive_seed(seed, 2)));
  scene->add_box({-0.15, -0.1, 0.73}, {0.22, 0.3, 0.05}, -0.3, cardboard(derive_seed(seed, 3)));
  scene->add_box({-0.13, -0.09, 0.78}, {0.19, 0.26, 0.035}, 0.2, cardboard(derive_seed(seed, 4)));
}

}  // namespace

Scene make_room(uint64_t seed) {
  Random random(derive_seed(seed, 100));
  Scene scene(kTexel);
  add_lights(&scene);
  const uint64_t floor_seed = random.next();
  const auto floor = [floor_seed](Canvas* canvas) {
    paint_planks(canvas, 0.14, Color(158, 118, 78), floor_seed);
    paint_carpet(canvas, {1.3, 1.0, 2.4, 2.0}, floor_seed + 1);
  };
  const uint64_t ceiling_seed = random.next();
  const auto ceiling = [ceiling_seed](Canvas* canvas) {
    paint_tiles(canvas, 0.6, Color(190, 188, 180), ceiling_seed);
  };
  scene.add_shell(kRoomSize,
                  {poster_wall(Color(170, 158, 138), 4, random.next()), window_wall(random.next()),
                   poster_wall(Color(148, 160, 146), 5, random.next()), door_wall(random.next()),
                   floor, ceiling});
  scene.add_box({-1.2, 1.8, 0}, {1.4, 0.32, 1.85}, 0, bookshelf(random.next()));
  scene.add_box({2.2, -0.6, 0}, {0.45, 1.3, 0.8}, 0,
                wooden(0.2, Color(108, 82, 74), random.next()));
  scene.add_box({2.2, -0.8, 0.8}, {0.26, 0.34, 0.3}, 0.3, cardboard(random.next()));
  scene.add_box({1.5, 1.7, 0}, {0.55, 0.42, 0.5}, 0.2, cardboard(random.next()));
  scene.add_box({1.45, 1.72, 0.5}, {0.4, 0.32, 0.35}, -0.25, cardboard(random.next()));
  scene.add_box({-0.9, -1.75, 0}, {1.5, 0.4, 0.7}, 0, bookshelf(random.next()));
  scene.add_box({-1.3, -1.75, 0.7}, {0.3, 0.24, 0.26}, 0.5, cardboard(random.next()));
  scene.add_box({-2.15, -1.2, 0}, {0.42, 0.5, 0.45}, 0.1, cardboard(random.next()));
  add_table(&scene, random.next());
  return scene;
}

namespace {

Painter white_paint(uint64_t seed) {
  return [=](Canvas* canvas) { paint_plaster(canvas, Color(190, 188, 184), 9, seed); };
}

/// White, with a skirting board, a switch, a few small pictures and marks.
Painter bare_wall(uint64_t seed) {
  return [=](Canvas* canvas) {
    Random random(seed);
    const Rect area = canvas->area();
    white_paint(random.next())(canvas);
    canvas->paint_rect({0, area.height - 0.08, area.width, 0.08}, Color(150, 148, 144));
    canvas->paint_rect({random.uniform(0.2, area.width - 0.3), area.height - 1.2, 0.08, 0.08},
                       Color(228, 228, 226));
    for (int i = 0; i < 3; ++i) {
      paint_poster(
          canvas,
          {area.width * (i + random.uniform(0.15, 0.7)) / 3, random.uniform(0.8, 1.4), 0.3, 0.22},
          random.next());
    }
    for (int i = 0; i < 12; ++i) {
      const double size = random.uniform(0.01, 0.03);
      canvas->paint_rect({random.uniform(0, area.width), random.uniform(0.4, area.height), size,
                          size * random.uniform(0.5, 2)},
                         Color(140, 138, 134));
    }
  };
}

}  // namespace

Scene make_low_texture_room(uint64_t seed) {
  Random random(derive_seed(seed, 200));
  Scene scene(kTexel);
  add_lights(&scene);
  std::vector<Painter> walls;
  walls.reserve(6);
  for (int i = 0; i < 6; ++i) {
    walls.push_back(i < 4 ? bare_wall(random.next()) : white_paint(random.next()));
  }
  scene.add_shell(kRoomSize, walls);
  const Painter paint = white_paint(random.next());
  const auto white = [&paint](Canvas* canvas, int) { paint(canvas); };
  scene.add_box({0.1, 0, 0}, {1.0, 0.7, 0.7}, 0.15, white);
  scene.add_box({-1.2, 1.75, 0}, {1.2, 0.4, 1.6}, 0, white);
  scene.add_box({2.15, -0.6, 0}, {0.5, 0.5, 0.5}, 0.3, cardboard(random.next()));
  return scene;
}

}  // namespace unisim::synth
