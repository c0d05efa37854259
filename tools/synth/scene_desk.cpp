// SPDX-License-Identifier: MIT
// A desk against a wall, with screen, books, boxes and paper on it.
#include "tools/synth/material.hpp"
#include "tools/synth/random.hpp"
#include "tools/synth/scene.hpp"

namespace unisim::synth {
namespace {

constexpr double kTexel = 0.0022;

Painter back_wall(uint64_t seed) {
  return [=](Canvas* canvas) {
    paint_plaster(canvas, Color(160, 168, 158), 44, seed);
    paint_poster(canvas, {0.7, 0.45, 0.7, 0.9}, derive_seed(seed, 1));
    paint_poster(canvas, {1.6, 0.6, 0.5, 0.4}, derive_seed(seed, 2));
    paint_poster(canvas, {2.3, 0.4, 0.8, 0.8}, derive_seed(seed, 3));
  };
}

Painter side_wall(uint64_t seed) {
  return [=](Canvas* canvas) {
    paint_plaster(canvas, Color(176, 164, 148), 44, seed);
    paint_poster(canvas, {1.0, 0.6, 0.9, 0.8}, derive_seed(seed, 1));
  };
}

void add_screen(Scene* scene, uint64_t seed) {
  const Eigen::Vector3d at = kDeskCenter + Eigen::Vector3d(-0.1, 0.22, 0);
  const auto dark = [](Canvas* canvas, int) { paint_plaster(canvas, Color(60, 60, 62), 12, 9); };
  scene->add_box(at, {0.2, 0.16, 0.02}, 0.1, dark);
  scene->add_box(at + Eigen::Vector3d(0, 0, 0.02), {0.05, 0.04, 0.1}, 0.1, dark);
  scene->add_box(at + Eigen::Vector3d(0, 0, 0.12), {0.52, 0.04, 0.32}, 0.1,
                 [=](Canvas* canvas, int face) {
                   const Rect area = canvas->area();
                   paint_plaster(canvas, Color(48, 48, 52), 10, seed);
                   if (face == 0) {
                     paint_poster(canvas, area.inset(0.012), derive_seed(seed, 1));
                     const Rect page{area.width * 0.45, area.height * 0.15, area.width * 0.4,
                                     area.height * 0.5};
                     canvas->paint_rect(page, Color(214, 216, 214));
                     paint_text(canvas, page.inset(0.01), 0.014, Color(40, 40, 60), seed);
                   }
                 });
}

void add_paper(Scene* scene, double x, double y, double yaw, uint64_t seed) {
  scene->add_box(kDeskCenter + Eigen::Vector3d(x, y, 0), {0.21, 0.297, 0.002}, yaw,
                 [=](Canvas* canvas, int) {
                   canvas->paint_rect(canvas->area(), Color(212, 210, 202));
                   paint_text(canvas, canvas->area().inset(0.02), 0.016, Color(40, 40, 46), seed);
                 });
}

}  // namespace

Scene make_desk(uint64_t seed) {
  Random random(derive_seed(seed, 400));
  Scene scene(kTexel);
  scene.add_light({{0.8, 0.0, 2.4}, 0.8});
  scene.add_light({{-0.9, -0.6, 2.4}, 0.6});
  const uint64_t floor_seed = random.next();
  const uint64_t back_seed = random.next();
  const uint64_t side_seed = random.next();
  scene.add_shell(
      kDeskRoomSize,
      {back_wall(back_seed), side_wall(side_seed), side_wall(side_seed + 1),
       side_wall(side_seed + 2),
       [=](Canvas* canvas) { paint_tiles(canvas, 0.25, Color(142, 130, 118), floor_seed); },
       [=](Canvas* canvas) { paint_plaster(canvas, Color(190, 188, 182), 20, floor_seed); }});
  const uint64_t wood = random.next();
  scene.add_box(
      kDeskCenter - Eigen::Vector3d(0, 0, 0.04), {1.6, 0.8, 0.04}, 0,
      [=](Canvas* canvas, int) { paint_planks(canvas, 0.13, Color(164, 120, 78), wood); });
  add_screen(&scene, random.next());
  add_paper(&scene, 0.0, -0.2, 0.25, random.next());
  add_paper(&scene, -0.35, -0.15, -0.5, random.next());
  const auto object = [&](double x, double y, double z, const Eigen::Vector3d& size, double yaw) {
    const uint64_t object_seed = random.next();
    scene.add_box(kDeskCenter + Eigen::Vector3d(x, y, z), size, yaw, [=](Canvas* canvas, int face) {
      paint_poster(canvas, canvas->area(), derive_seed(object_seed, static_cast<uint64_t>(face)));
    });
  };
  object(0.45, 0.1, 0, {0.17, 0.24, 0.04}, 0.3);
  object(0.46, 0.11, 0.04, {0.15, 0.21, 0.03}, 0.1);
  object(0.44, 0.1, 0.07, {0.13, 0.19, 0.035}, 0.5);
  object(-0.58, 0.2, 0, {0.16, 0.12, 0.24}, 0.2);
  object(0.28, -0.22, 0, {0.09, 0.09, 0.11}, 0.7);
  object(0.62, -0.15, 0, {0.2, 0.13, 0.13}, -0.4);
  object(-0.62, -0.2, 0, {0.14, 0.2, 0.06}, -0.2);
  return scene;
}

}  // namespace unisim::synth
