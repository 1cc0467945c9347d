#include "render/text_raster.h"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/utf8.h"

// font.S
extern "C" {
extern const unsigned char atomesh_font_begin[];
extern const unsigned char atomesh_font_end[];
}

namespace atomesh {

namespace {

void require_size(double size) {
  if (!(size >= 1.0 && size <= 1000.0)) throw UsageError("text of " + std::to_string(size) + " pixels: 1 to 1000");
}

// FreeType must not be called by two threads at once with the same library: each thread has its own.
class Font {
 public:
  Font() {
    if (FT_Init_FreeType(&library_) != 0) throw UnavailableError("FreeType could not be started (out of memory)");
    const auto bytes = static_cast<FT_Long>(atomesh_font_end - atomesh_font_begin);
    if (FT_New_Memory_Face(library_, atomesh_font_begin, bytes, 0, &face_) != 0) {
      FT_Done_FreeType(library_);
      throw UnavailableError("the font in this program cannot be read: it was built wrongly");
    }
  }
  ~Font() {
    FT_Done_Face(face_);
    FT_Done_FreeType(library_);
  }
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;

  static Font& of_this_thread() {
    thread_local Font font;
    return font;
  }

  void set_size(double size) {
    require_size(size);
    // At 72 dots per inch a point is a pixel; sizes are in 64ths.
    FT_Set_Char_Size(face_, 0, static_cast<FT_F26Dot6>(std::lround(64.0 * size)), 72, 72);
  }
  // The character's glyph, in face()->glyph. Lines are fitted to the rows of pixels, which keeps small text crisp, and
  // not to the columns, so that widths are in proportion.
  bool load(char32_t character, bool draw) {
    return FT_Load_Char(face_, character, (draw ? FT_LOAD_RENDER : FT_LOAD_DEFAULT) | FT_LOAD_TARGET_LIGHT) == 0;
  }
  FT_Face face() const { return face_; }

  // To the next character, in pixels for a size of 1: what the font's own units say.
  double advance(char32_t character) {
    FT_Load_Char(face_, character, FT_LOAD_NO_SCALE);
    return static_cast<double>(face_->glyph->metrics.horiAdvance) / face_->units_per_EM;
  }

 private:
  FT_Library library_ = nullptr;
  FT_Face face_ = nullptr;
};

// A character's picture and where its first pixel is.
struct Glyph {
  CanvasBox box;
  std::vector<unsigned char> coverage;  // of 255, row by row
};

// None where the line does not come near to what the canvas shows.
std::vector<Glyph> rasterize(const Canvas& canvas, std::string_view text, double x, double baseline, double size,
                             int margin) {
  const auto [top, bottom] = std::pair(std::floor(baseline - 2.0 * size) - margin, baseline + size + margin + 1.0);
  constexpr int everywhere = std::numeric_limits<int>::max();
  if (!(bottom > 0.0 && top < 1e9) ||
      canvas.clipped({0, static_cast<int>(std::max(top, 0.0)), everywhere, static_cast<int>(std::min(bottom, 1e9))})
              .height() <= 0) {
    return {};
  }
  Font& font = Font::of_this_thread();
  font.set_size(size);
  std::vector<Glyph> glyphs;
  while (!text.empty()) {
    const char32_t character = take_character(text);
    // Between two columns: the outline is moved before it is drawn.
    const double column = std::floor(x);
    FT_Vector offset{static_cast<FT_Pos>(std::lround(64.0 * (x - column))), 0};
    FT_Set_Transform(font.face(), nullptr, &offset);
    if (font.load(character, true)) {
      const FT_GlyphSlot slot = font.face()->glyph;
      const FT_Bitmap& bitmap = slot->bitmap;
      Glyph glyph;
      glyph.box.left = static_cast<int>(column) + slot->bitmap_left;
      glyph.box.top = static_cast<int>(std::lround(baseline)) - slot->bitmap_top;
      glyph.box.right = glyph.box.left + static_cast<int>(bitmap.width);
      glyph.box.bottom = glyph.box.top + static_cast<int>(bitmap.rows);
      for (unsigned row = 0; row < bitmap.rows; ++row) {
        const unsigned char* line = bitmap.buffer + static_cast<std::ptrdiff_t>(row) * bitmap.pitch;
        glyph.coverage.insert(glyph.coverage.end(), line, line + bitmap.width);
      }
      glyphs.push_back(std::move(glyph));
    }
    FT_Set_Transform(font.face(), nullptr, nullptr);
    x += size * font.advance(character);
  }
  return glyphs;
}

void draw_glyph(Canvas& canvas, const Glyph& glyph, int right, int down, const Vec4f& color) {
  const CanvasBox box{glyph.box.left + right, glyph.box.top + down, glyph.box.right + right, glyph.box.bottom + down};
  const CanvasBox here = canvas.clipped(box);
  for (int row = here.top; row < here.bottom; ++row) {
    const unsigned char* coverage = glyph.coverage.data() + static_cast<std::ptrdiff_t>(row - box.top) * box.width();
    for (int column = here.left; column < here.right; ++column) {
      canvas.blend(column, row, color, static_cast<float>(coverage[column - box.left]) / 255.0F);
    }
  }
}

}  // namespace

TextExtent measure_text(std::string_view text, double size) {
  Font& font = Font::of_this_thread();
  font.set_size(size);
  double width = 0.0;
  while (!text.empty()) width += font.advance(take_character(text));
  // Of DejaVu Sans: capital letters are 0.729 em high, letters like p and the brackets reach 0.236 em down.
  return {width * size, 0.729 * size, 0.236 * size};
}

void draw_text(Canvas& canvas, std::string_view text, double x, double baseline, double size, const Vec4f& color) {
  require_size(size);
  for (const Glyph& glyph : rasterize(canvas, text, x, baseline, size, 0)) draw_glyph(canvas, glyph, 0, 0, color);
}

void draw_text_with_rim(Canvas& canvas, std::string_view text, double x, double baseline, double size,
                        const Vec4f& color, const Vec4f& rim) {
  require_size(size);
  const int reach = static_cast<int>(std::max(1.0, std::round(0.1 * size)));
  const int aslant = static_cast<int>(std::max(1.0, std::round(0.1 * size * std::sqrt(0.5))));
  const std::vector<Glyph> glyphs = rasterize(canvas, text, x, baseline, size, reach);
  for (const Glyph& glyph : glyphs) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const int step = dx != 0 && dy != 0 ? aslant : reach;
        if (dx != 0 || dy != 0) draw_glyph(canvas, glyph, dx * step, dy * step, rim);
      }
    }
  }
  for (const Glyph& glyph : glyphs) draw_glyph(canvas, glyph, 0, 0, color);
}

bool has_glyph(char32_t character) {
  return FT_Get_Char_Index(Font::of_this_thread().face(), character) != 0;
}

}  // namespace atomesh
