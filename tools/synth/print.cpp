// SPDX-License-Identifier: MIT
// Printed things: posters, text, book spines.
#include "tools/synth/material.hpp"
#include "tools/synth/noise.hpp"
#include "tools/synth/random.hpp"

namespace unisim::synth {
namespace {

Color random_color(Random* random) {
  const auto hue = static_cast<float>(random->uniform(0, 6.2831853));
  const auto value = static_cast<float>(random->uniform(50, 215));
  const auto chroma = static_cast<float>(random->uniform(5, 40));
  return {value + chroma * std::cos(hue), value + chroma * std::cos(hue - 2.1f),
          value + chroma * std::cos(hue + 2.1f)};
}

/// A box, disc, ring or bar, turned by any angle.
void paint_shape(Canvas* canvas, const Rect& clip, double size, Random* random) {
  const double x0 = random->uniform(clip.x, clip.x + clip.width);
  const double y0 = random->uniform(clip.y, clip.y + clip.height);
  const double angle = random->uniform(0, 3.14159265);
  const double aspect = random->uniform(0.25, 1);
  const int kind = random->below(4);
  const Color color = random_color(random);
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const auto distance = [&](double x, double y) {
    const double u = c * (x - x0) + s * (y - y0);
    const double v = c * (y - y0) - s * (x - x0);
    double shape = box_distance(u, v, size, size * aspect);
    if (kind == 1) {
      shape = std::hypot(u, v) - size;
    } else if (kind == 2) {
      shape = std::abs(std::hypot(u, v) - size * 0.8) - size * 0.2;
    }
    const double outside =
        box_distance(x - clip.center_x(), y - clip.center_y(), clip.width / 2, clip.height / 2);
    return std::max(shape, outside);
  };
  const double reach = size * 1.5;
  canvas->paint({x0 - reach, y0 - reach, 2 * reach, 2 * reach}, distance,
                [&](double, double) -> const Color& { return color; });
}

}  // namespace

void paint_text(Canvas* canvas, const Rect& rect, double line_height, const Color& ink,
                uint64_t seed) {
  Random random(seed);
  const double glyph = line_height * 0.45;
  for (double y = rect.y; y + line_height * 0.7 <= rect.y + rect.height; y += line_height) {
    const double line_end = rect.x + rect.width * random.uniform(0.55, 1);
    for (double x = rect.x; x + glyph <= line_end; x += glyph) {
      if (random.uniform() < 0.16) {
        continue;  // space between words
      }
      const double height = line_height * (random.uniform() < 0.3 ? 0.68 : 0.45);
      const double base = y + line_height * 0.68;
      const double stroke = glyph * 0.22;
      canvas->paint_rect({x, base - height, stroke, height}, ink);
      if (random.uniform() < 0.6) {
        canvas->paint_rect({x + glyph * 0.5, base - height * random.uniform(0.6, 1), stroke,
                            height * random.uniform(0.4, 0.6)},
                           ink);
      }
      canvas->paint_rect({x, base - height * random.uniform(0.2, 1), glyph * 0.7, stroke}, ink);
    }
  }
}

void paint_poster(Canvas* canvas, const Rect& rect, uint64_t seed) {
  Random random(seed);
  canvas->paint_rect(rect, Color(40, 36, 34));
  const double frame = std::min(0.02, 0.06 * std::min(rect.width, rect.height));
  const Rect sheet = rect.inset(frame);
  const Color top = random_color(&random);
  const Color bottom = random_color(&random);
  const auto distance = [&sheet](double x, double y) {
    return box_distance(x - sheet.center_x(), y - sheet.center_y(), sheet.width / 2,
                        sheet.height / 2);
  };
  canvas->paint(sheet, distance, [&](double x, double y) -> Color {
    const auto mix = static_cast<float>((y - sheet.y) / sheet.height);
    const float cloud =
        fractal_noise(static_cast<float>(x * 3), static_cast<float>(y * 3), seed, 7, 0.65f);
    return (1 - mix) * top + mix * bottom + Color::Constant(38 * cloud);
  });
  // Few large shapes, many small ones: as many again at each half of the size.
  const double largest = 0.25 * std::min(sheet.width, sheet.height);
  int count = 3;
  for (double size = largest; size > std::min(0.008, 0.12 * largest); size *= 0.6) {
    for (int i = 0; i < count; ++i) {
      paint_shape(canvas, sheet, size * random.uniform(0.7, 1.2), &random);
    }
    count = count * 8 / 5;
  }
  const Rect caption{sheet.x + 0.03, sheet.y + sheet.height * 0.8, sheet.width - 0.06,
                     sheet.height * 0.18};
  paint_text(canvas, caption, 0.05, random_color(&random) * 0.3f, derive_seed(seed, 7));
}

void paint_books(Canvas* canvas, const Rect& rect, uint64_t seed) {
  Random random(seed);
  canvas->paint_rect(rect, Color(30, 24, 20));
  double x = rect.x;
  while (true) {
    const double width = random.uniform(0.018, 0.055);
    if (x + width > rect.x + rect.width) {
      break;
    }
    const double height = rect.height * random.uniform(0.7, 0.97);
    const Rect spine{x, rect.y + rect.height - height, width - 0.002, height};
    const Color cover = random_color(&random);
    canvas->paint_rect(spine, cover);
    const Color ink = random_color(&random);
    canvas->paint_rect({spine.x, spine.y + height * random.uniform(0.05, 0.2), spine.width, 0.008},
                       ink);
    paint_text(canvas, {spine.x + width * 0.2, spine.y + height * 0.3, width * 0.6, height * 0.45},
               0.018, ink, random.next());
    x += width;
  }
}

}  // namespace unisim::synth
