// SPDX-License-Identifier: MIT
// A long office corridor with doors, notice boards and boxes.
#include "tools/synth/material.hpp"
#include "tools/synth/random.hpp"
#include "tools/synth/scene.hpp"

namespace unisim::synth {
namespace {

constexpr double kTexel = 0.006;

/// Doors and notices in turn along a wall.
Painter long_wall(const Color& base, uint64_t seed) {
  return [=](Canvas* canvas) {
    Random random(seed);
    const Rect area = canvas->area();
    paint_plaster(canvas, base, 44, random.next());
    double x = random.uniform(0.3, 1.2);
    for (int i = 0; x + 1.2 < area.width; ++i) {
      if (i % 2 == 0) {
        paint_door(canvas, {x, area.height - 2.1, 0.95, 2.1}, random.next());
      } else {
        paint_poster(canvas, {x, random.uniform(0.5, 0.9), random.uniform(0.6, 1.1), 0.8},
                     random.next());
      }
      x += random.uniform(1.3, 2.0);
    }
    canvas->paint_rect({0, area.height - 0.12, area.width, 0.12}, Color(96, 92, 88));
  };
}

Painter end_wall(uint64_t seed) {
  return [=](Canvas* canvas) {
    paint_plaster(canvas, Color(168, 160, 150), 44, seed);
    paint_poster(canvas, {0.25, 0.4, 0.8, 1.1}, derive_seed(seed, 1));
    paint_poster(canvas, {1.3, 0.6, 0.85, 0.7}, derive_seed(seed, 2));
  };
}

}  // namespace

Scene make_corridor(uint64_t seed) {
  Random random(derive_seed(seed, 300));
  Scene scene(kTexel);
  for (double x = -10.5; x < 12; x += 3) {
    scene.add_light({{x, 0, 2.5}, 0.4});
  }
  const uint64_t floor_seed = random.next();
  const uint64_t ceiling_seed = random.next();
  scene.add_shell(
      kCorridorSize,
      {long_wall(Color(172, 164, 140), random.next()), end_wall(random.next()),
       long_wall(Color(150, 162, 164), random.next()), end_wall(random.next()),
       [=](Canvas* canvas) { paint_tiles(canvas, 0.3, Color(140, 132, 124), floor_seed); },
       [=](Canvas* canvas) { paint_tiles(canvas, 0.6, Color(186, 186, 182), ceiling_seed); }});
  int side = 1;
  for (double x = -8; x < 12; x += random.uniform(1.8, 3.0)) {
    const uint64_t box_seed = random.next();
    const double size = random.uniform(0.25, 0.42);
    scene.add_box({x, side * (1.2 - size * 0.7), 0}, {size, size * 0.9, random.uniform(0.3, 0.9)},
                  random.uniform(-0.3, 0.3), [=](Canvas* canvas, int face) {
                    paint_cardboard(canvas, derive_seed(box_seed, static_cast<uint64_t>(face)));
                  });
    side = -side;
  }
  return scene;
}

}  // namespace unisim::synth
