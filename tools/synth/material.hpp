// SPDX-License-Identifier: MIT
// What the surfaces of the scenes are made of. Each function paints a canvas, or a part of it, from
// a seed; detail runs from the size of the part down to a few texels.
#pragma once

#include <cstdint>

#include "tools/synth/canvas.hpp"

namespace unisim::synth {

/// Rough paint: base colour with stains of every size. @param contrast  grey levels of the largest
void paint_plaster(Canvas* canvas, const Color& base, float contrast, uint64_t seed);

/// Wooden boards along x.
void paint_planks(Canvas* canvas, double board_width, const Color& base, uint64_t seed);

/// Square tiles, each of its own shade, with dark joints.
void paint_tiles(Canvas* canvas, double tile, const Color& base, uint64_t seed);

/// Woven floor covering with a border and blocks of pattern.
void paint_carpet(Canvas* canvas, const Rect& rect, uint64_t seed);

/// Framed picture: shapes of every size over a shaded ground, with lines of text.
void paint_poster(Canvas* canvas, const Rect& rect, uint64_t seed);

/// Lines of strokes that look like print.
void paint_text(Canvas* canvas, const Rect& rect, double line_height, const Color& ink,
                uint64_t seed);

/// Spines of books standing side by side.
void paint_books(Canvas* canvas, const Rect& rect, uint64_t seed);

/// Packing paper with tape, a label and print.
void paint_cardboard(Canvas* canvas, uint64_t seed);

/// Frame with panes and a blurred outdoors behind them.
void paint_window(Canvas* canvas, const Rect& rect, uint64_t seed);

/// Panelled door with a handle and a sign.
void paint_door(Canvas* canvas, const Rect& rect, uint64_t seed);

}  // namespace unisim::synth
