#include "app/cli/render_legend.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "app/cli/session.h"

namespace atomesh::cli {

namespace {

std::string color_text(const Vec3f& color) {
  const auto byte = [](float channel) { return std::lround(255.0F * std::clamp(channel, 0.0F, 1.0F)); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(color.r), byte(color.g), byte(color.b));
}

Json box_json(const CanvasBox& box) {
  return Json::array({box.left, box.top, box.right, box.bottom});
}

}  // namespace

void add_legend_options(CLI::App& app, LegendOptions& options) {
  app.add_flag(
      "--legend", options.legend,
      "Draw what the colors mean into the picture: thickness in Å (mode xray), the color map with its scalar's "
      "range, the defects' colors, or the species");
  app.add_flag("--scale-bar", options.scale_bar,
               "Draw how long a round number of Å or nm is; in perspective at the depth of the sample's center");
  app.add_flag("--tripod", options.tripod,
               "Draw which way x, y and z point and, where they differ, the cell's a, b and c");
}

Channels PictureLegend::channels(const Channels& wanted) {
  Channels channels = wanted;
  if (goes_by_thickness() && channels.thickness == nullptr) channels.thickness = &own_thickness_;
  thickness_ = channels.thickness;
  return channels;
}

void PictureLegend::lay_out(const Scene& scene, const Material& material, const Parameters& parameters,
                            const Camera& camera, std::optional<double> thickest, Session& session) {
  if (options_.legend) {
    if (!thickest) {
      thickest = thickness_ == nullptr || thickness_->empty()
                     ? 0.0
                     : static_cast<double>(*std::max_element(thickness_->begin(), thickness_->end()));
    }
    legend_ = make_legend(scene, material, parameters, *thickest);
    if (!legend_) {
      session.note(mode_ == Mode::surface ? "--legend: mode surface has one color, there is nothing to explain"
                                          : "--legend: the picture shows nothing that could be explained");
    }
  }
  if (options_.scale_bar) {
    scale_bar_ = make_scale_bar(camera, scene.bounds.center(), material.atoms.size() > 0);
    if (!scale_bar_) session.note("--scale-bar: the sample's center is not in front of the viewer");
  }
  drawing_.emplace(camera.width, camera.height, parameters.background, legend_, scale_bar_);
  if (options_.tripod) {
    tripods_ = make_tripods(material.unit_cell);
    const auto& bar = drawing_->scale_bar_box();
    tripod_.emplace(camera, parameters.background, tripods_, bar ? bar->top : camera.height);
  }
  const auto too_small = [&](const char* option) {
    session.note(
        fmt::format("{}: the picture of {}x{} pixels has no room for it", option, camera.width, camera.height));
  };
  if (legend_ && !drawing_->legend_box()) too_small("--legend");
  if (scale_bar_ && !drawing_->scale_bar_box()) too_small("--scale-bar");
  if (tripod_ && !tripod_->box()) too_small("--tripod");
}

void PictureLegend::draw(Image& band, int first_row) const {
  Canvas canvas(band, first_row);
  if (drawing_) drawing_->draw(canvas);
  if (tripod_) tripod_->draw(canvas);
}

void PictureLegend::add_to(Json& json) const {
  if (drawing_ && drawing_->legend_box()) {
    Json legend = Json::object({{"title", legend_->title}});
    if (legend_->scale) {
      const LegendScale& scale = *legend_->scale;
      legend.set("range", Json::array({scale.min, scale.max}));
      if (mode_ == Mode::xray) legend.set("opaque_from", scale.mark ? Json(*scale.mark) : Json());
    }
    if (!legend_->entries.empty()) {
      Json entries = Json::array();
      for (const LegendEntry& entry : legend_->entries) {
        entries.push(Json::object({{"name", entry.name}, {"color", color_text(entry.color)}}));
      }
      legend.set("entries", entries);
    }
    legend.set("box", box_json(*drawing_->legend_box()));
    json.set("legend", legend);
  }
  if (drawing_ && drawing_->scale_bar_box()) {
    json.set("scale_bar", Json::object({{"length", scale_bar_->length},
                                        {"pixels", scale_bar_->pixels},
                                        {"text", scale_bar_->text},
                                        {"box", box_json(*drawing_->scale_bar_box())}}));
  }
  if (tripod_ && tripod_->box()) {
    Json arrows = Json::array();
    for (const auto& tripod : tripods_) {
      for (const TripodArrow& arrow : tripod) arrows.push(arrow.name);
    }
    json.set("tripod", Json::object({{"arrows", arrows}, {"box", box_json(*tripod_->box())}}));
  }
}

}  // namespace atomesh::cli
