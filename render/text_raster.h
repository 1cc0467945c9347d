// Text in pictures, without a display: FreeType, and one font inside the program (DejaVu Sans), so that a picture looks
// the same wherever it is made.
#pragma once

#include <string_view>

#include "render/canvas.h"

namespace atomesh {

// In pixels; `size` is the font's em.
struct TextExtent {
  double width = 0.0;    // how far the next text would start
  double ascent = 0.0;   // of a capital letter or digit above the baseline
  double descent = 0.0;  // of the lowest letter below it
};

// UTF-8; a character that the font does not have shows as a box. Width is proportional to size. Throws UsageError for a
// size outside 1 … 1000.
TextExtent measure_text(std::string_view text, double size);

// Antialiased, its first character's origin at (x, baseline) in pixels from the picture's upper left corner. Throws as
// measure_text() does.
void draw_text(Canvas& canvas, std::string_view text, double x, double baseline, double size, const Vec4f& color);

// The same with a rim of another colour around every letter, to be read over anything.
void draw_text_with_rim(Canvas& canvas, std::string_view text, double x, double baseline, double size,
                        const Vec4f& color, const Vec4f& rim);

// Whether the font has it.
bool has_glyph(char32_t character);

}  // namespace atomesh
