#include "render/legend_drawing.h"

#include <algorithm>
#include <cmath>

#include "core/axis_ticks.h"
#include "core/utf8.h"
#include "render/text_raster.h"

namespace atomesh {

namespace {

// Below this panels are dark: between black and white as the eye sees it.
constexpr float dark_below = 0.4F;
// The least with which black text on the light panel keeps a contrast of 7:1 over a black sample, and white text on the
// dark panel over a white one.
constexpr float panel_opacity = 0.82F;

float luma(const Vec4f& color) {
  const float over_white = 0.2126F * color.r + 0.7152F * color.g + 0.0722F * color.b;
  return color.a * over_white + (1.0F - color.a);
}

}  // namespace

double overlay_text_size(int width, int height) {
  return std::clamp(0.024 * std::min(width, height), 9.0, 400.0);
}

OverlayColors overlay_colors(const Vec4f& background) {
  if (luma(background) < dark_below) return {Vec4f(0.07F, 0.07F, 0.08F, 1.0F), Vec4f(0.96F, 0.96F, 0.96F, 1.0F)};
  return {Vec4f(1.0F), Vec4f(0.08F, 0.08F, 0.08F, 1.0F)};
}

LegendDrawing::LegendDrawing(int width, int height, const Vec4f& background, const std::optional<Legend>& legend,
                             const std::optional<ScaleBar>& scale_bar)
    : width_(width), height_(height), size_(overlay_text_size(width, height)) {
  margin_ = pixels(0.8);
  pad_ = pixels(0.6);
  line_ = std::max(1, pixels(0.08));
  const OverlayColors colors = overlay_colors(background);
  panel_ = Vec4f(Vec3f(colors.paper), panel_opacity);
  ink_ = colors.ink;
  if (legend && legend->scale) lay_out_scale(*legend);
  if (legend && !legend->entries.empty()) lay_out_entries(*legend);
  if (scale_bar) lay_out_scale_bar(*scale_bar);
}

int LegendDrawing::pixels(double ems) const {
  return static_cast<int>(std::lround(ems * size_));
}

double LegendDrawing::width_of(const std::string& text) const {
  return measure_text(text, size_).width;
}

bool LegendDrawing::fits(int width, int height) const {
  return width + 2 * margin_ <= width_ && height + 2 * margin_ <= height_;
}

std::string LegendDrawing::shortened(const std::string& text, double room) const {
  if (width_of(text) <= room) return text;
  std::string kept;
  std::string_view rest = text;
  while (!rest.empty()) {
    const std::string_view before = rest;
    take_character(rest);
    const std::string longer = kept + std::string(before.substr(0, before.size() - rest.size()));
    if (width_of(longer + "…") > room) break;
    kept = longer;
  }
  return kept + "…";
}

// Title, and below it the bar of colours with ticks and texts to its right.
void LegendDrawing::lay_out_scale(const Legend& legend) {
  const LegendScale& scale = *legend.scale;
  const int bar_height = std::max(pixels(5.0), static_cast<int>(std::lround(0.36 * height_)));
  const int bar_width = pixels(1.3);
  const int tick = pixels(0.35);
  const double text_gap = 0.3 * size_;
  const double room = 0.5 * width_ - 2.0 * pad_;

  const double range = 0.5 * scale.max - 0.5 * scale.min;  // halved, so that none is too long for a double
  const auto place = [&](double value) { return range > 0.0 ? (0.5 * value - 0.5 * scale.min) / range : 0.5; };
  struct Label {
    double place;  // 0 at the bottom
    std::string text;
  };
  std::vector<Label> labels;
  // The first to come takes the room.
  const auto add = [&](double value, const std::string& text) {
    const double at = place(value);
    for (const Label& other : labels) {
      if (std::abs(at - other.place) * bar_height < 1.4 * size_) return;
    }
    labels.push_back({at, text});
  };
  if (scale.mark) add(*scale.mark, scale.mark_text);
  add(scale.max, (scale.above ? "≥ " : "") + rounded_text(scale.max, 3));
  add(scale.min, (scale.below ? "≤ " : "") + rounded_text(scale.min, 3));
  const int at_most = std::max(2, static_cast<int>(bar_height / (2.0 * size_)));
  for (const AxisTick& t : linear_ticks(scale.min, scale.max, at_most)) add(t.value, t.text);

  double label_width = 0.0;
  for (const Label& label : labels) label_width = std::max(label_width, width_of(label.text));
  const std::string title = shortened(legend.title, room);
  const double wanted = std::max(bar_width + tick + text_gap + label_width, title.empty() ? 0.0 : width_of(title));
  const double title_height = title.empty() ? 0.0 : 1.5 * size_;
  const int width = static_cast<int>(std::ceil(wanted)) + 2 * pad_;
  // Half a line above and below the bar, for the texts at its ends.
  const int height = 2 * pad_ + static_cast<int>(std::ceil(title_height + 0.8 * size_)) + bar_height;
  if (!fits(width, height)) return;

  const CanvasBox box{width_ - margin_ - width, height_ - margin_ - height, width_ - margin_, height_ - margin_};
  const CanvasBox bar{box.left + pad_ + line_, box.bottom - pad_ - pixels(0.4) - bar_height,
                      box.left + pad_ + line_ + bar_width, box.bottom - pad_ - pixels(0.4)};
  if (!title.empty()) texts_.push_back({title, 1.0 * box.left + pad_, box.top + pad_ + 0.78 * size_});
  for (const Label& label : labels) {
    const double y = bar.bottom - label.place * bar_height;
    const int row = std::clamp(static_cast<int>(std::lround(y - 0.5 * line_)), bar.top, bar.bottom - line_);
    lines_.push_back({bar.right + line_, row, bar.right + line_ + tick, row + line_});
    texts_.push_back({label.text, bar.right + line_ + tick + text_gap, y + 0.36 * size_});
  }
  if (scale.mark) {
    const int row = static_cast<int>(std::lround(bar.bottom - place(*scale.mark) * bar_height - 0.5 * line_));
    // Black or white, whichever stands out from the colour there.
    const bool dark = luma(scale.color(*scale.mark)) < 0.5F;
    mark_ = Mark{{bar.left, row, bar.right, row + line_}, Vec4f(Vec3f(dark ? 1.0F : 0.0F), 1.0F)};
  }
  legend_box_ = box;
  color_bar_ = bar;
  bar_color_ = [color = scale.color, low = scale.min, high = scale.max](double along) {
    return color(low * (1.0 - along) + high * along);
  };
}

// One row for each: swatch and name; what does not fit is counted in a last row.
void LegendDrawing::lay_out_entries(const Legend& legend) {
  const int row_height = pixels(1.5);
  const int swatch = pixels(1.0);
  const double gap = 0.5 * size_;
  const double room = 0.5 * width_ - 2.0 * pad_ - swatch - gap;
  const int most = (height_ - 2 * margin_ - 2 * pad_) / row_height;
  if (most < 1) return;
  std::vector<LegendEntry> entries = legend.entries;
  std::string more;
  if (static_cast<int>(entries.size()) > most) {
    more = "and " + std::to_string(static_cast<int>(entries.size()) - most + 1) + " more";
    entries.resize(static_cast<std::size_t>(most - 1));
  }
  double widest = more.empty() ? 0.0 : width_of(more);
  for (LegendEntry& entry : entries) {
    entry.name = shortened(entry.name, room);
    widest = std::max(widest, width_of(entry.name));
  }
  const int rows = static_cast<int>(entries.size()) + (more.empty() ? 0 : 1);
  const int width = 2 * pad_ + swatch + static_cast<int>(std::ceil(gap + widest));
  const int height = 2 * pad_ + rows * row_height - pixels(0.4);
  if (!fits(width, height)) return;

  const CanvasBox box{width_ - margin_ - width, height_ - margin_ - height, width_ - margin_, height_ - margin_};
  const double text_x = box.left + pad_ + swatch + gap;
  int top = box.top + pad_;
  for (const LegendEntry& entry : entries) {
    const CanvasBox square{box.left + pad_, top, box.left + pad_ + swatch, top + swatch};
    swatches_.push_back({square, legend.balls ? 0.5 * swatch : 0.15 * swatch, Vec4f(entry.color, 1.0F)});
    texts_.push_back({entry.name, text_x, top + 0.5 * swatch + 0.36 * size_});
    top += row_height;
  }
  if (!more.empty()) texts_.push_back({more, text_x, top + 0.5 * swatch + 0.36 * size_});
  legend_box_ = box;
}

// The length in words over a bar with ends.
void LegendDrawing::lay_out_scale_bar(const ScaleBar& bar) {
  const int length = static_cast<int>(std::lround(bar.pixels));
  const int thick = std::max(2, pixels(0.18));
  const int end = pixels(0.7);
  const double text_width = width_of(bar.text);
  const int content = std::max(length, static_cast<int>(std::ceil(text_width)));
  const int width = content + 2 * pad_;
  const int height = 2 * pad_ + pixels(1.2) + end;
  if (length < 4 || !fits(width, height)) return;
  const CanvasBox box{margin_, height_ - margin_ - height, margin_ + width, height_ - margin_};
  // Both stand on the picture's lower edge.
  if (legend_box_ && box.right > legend_box_->left) return;
  const int left = box.left + pad_ + (content - length) / 2;
  const int middle = box.bottom - pad_ - end / 2;
  lines_.push_back({left, middle - thick / 2, left + length, middle - thick / 2 + thick});
  lines_.push_back({left, box.bottom - pad_ - end, left + line_, box.bottom - pad_});
  lines_.push_back({left + length - line_, box.bottom - pad_ - end, left + length, box.bottom - pad_});
  texts_.push_back({bar.text, box.left + pad_ + 0.5 * (content - text_width), box.top + pad_ + 0.75 * size_});
  scale_bar_box_ = box;
}

void LegendDrawing::draw(Canvas& canvas) const {
  const double round = 0.4 * size_;
  if (legend_box_) canvas.fill_rounded(*legend_box_, round, panel_);
  if (scale_bar_box_) canvas.fill_rounded(*scale_bar_box_, round, panel_);
  const Vec4f faint(Vec3f(ink_), 0.6F);
  if (color_bar_) {
    const CanvasBox here = canvas.clipped(*color_bar_);
    for (int row = here.top; row < here.bottom; ++row) {
      // The colour of the picture's pixels themselves, see-through ones too.
      const Vec4f color = bar_color_((color_bar_->bottom - (row + 0.5)) / color_bar_->height());
      for (int column = here.left; column < here.right; ++column) canvas.set(column, row, color);
    }
    canvas.frame(*color_bar_, line_, faint);
    if (mark_) canvas.fill(mark_->box, mark_->color);
  }
  for (const Swatch& swatch : swatches_) {
    // A rim, so that a swatch of the panel's colour is seen.
    const int rim = line_;
    canvas.fill_rounded({swatch.box.left - rim, swatch.box.top - rim, swatch.box.right + rim, swatch.box.bottom + rim},
                        swatch.radius + rim, faint);
    canvas.fill_rounded(swatch.box, swatch.radius, swatch.color);
  }
  for (const CanvasBox& line : lines_) canvas.fill(line, ink_);
  for (const Text& text : texts_) draw_text(canvas, text.text, text.x, text.baseline, size_, ink_);
}

}  // namespace atomesh
