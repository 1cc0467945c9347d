// bench error, part hard-cases.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "app/cli/bench_error.h"
#include "app/cli/bench_render_tools.h"
#include "app/cli/hard_case_errors.h"
#include "preprocess/tetrahedralize.h"
#include "samples/hard_cases.h"

namespace atomesh::cli {

namespace {

constexpr double beside = fast_rays_beside;

struct Worst {
  double length = 0.0;      // relative, or in parts of what is granted to a short one where that is more
  double thickness = 0.0;   // of xray, alike
  double values = 0.0;      // from the judge
  double unresolved = 0.0;  // the same in views whose values floats cannot tell
  std::size_t pixels = 0;

  void add_length(const LengthError& error) {
    length = std::max({length, error.relative, closed_form_limit * error.granted, error.color});
    pixels += error.pixels;
  }
};

class HardCaseTable {
 public:
  explicit HardCaseTable(RenderBench& bench) : bench_(bench) {}

  void measure(const HardCase& hard) {
    bench_.session.progress().stage("hard case: " + hard.name);
    if (hard.known == HardCase::Known::nothing) {
      measure_harm(hard);
      return;
    }
    Worst worst;
    for (const HardView& view : hard.views) {
      const KnownLengths known(hard, view.camera, beside);
      for (const Mode mode : {Mode::volume, Mode::volume_surface}) measure_lengths(hard, view, mode, known, worst);
      const Parameters parameters = constant_density(Mode::xray, hard.extinctions.front());
      const Scene scene = make_scene(hard.material, parameters, bench_.session.progress());
      std::vector<float> thickness;
      draw(scene, view.camera, parameters, &thickness);
      const LengthError error = known.of_thickness(thickness);
      worst.thickness = std::max({worst.thickness, error.relative, closed_form_limit * error.granted});
    }
    if (hard.known == HardCase::Known::values) {
      for (const Mode mode : {Mode::volume, Mode::volume_surface}) measure_values(hard, mode, worst);
    }
    report(hard, worst);
  }

  BenchTable take() {
    return {
        "Hard cases",
        std::move(table_),
        fmt::format(
            "Length: largest relative error of the optical depth of a constant density, which is known from the "
            "solid's shape, in the modes volume and volume-surface, by every integrator, at every extinction and "
            "in every view; differences of depths shorter than a hundred thousand roundings of the sample's "
            "half-diameter are held to {} such roundings ({} in perspective) and count as 1e-5 where they need "
            "them all: that is granted to chords below about 5 % of the half-diameter (10 % in perspective), a "
            "cell thinner than its granted roundings may leave its length to its neighbours, and that thicker "
            "slivers are met once by every ray their test counts. Thickness: the same of mode xray's channel. Values: "
            "largest difference from the judge where "
            "the values vary, by the closed form. Rays within 4e-6 of a pixel of the centre count as its own. "
            "Unresolved: the same in views whose rays run inside cells a few hundred thousandths of a "
            "pixel wide, where "
            "floats cannot tell which of the values between the cell's sides holds; nothing is required of it. "
            "\"-\": nobody has laid down which of the cells that overlap comes first. \"in [0,1]\": nothing is known "
            "of cells that are inside out but that they are drawn in colors, by us and by the judge.",
            granted_roundings, 2.0 * granted_roundings),
        {}};
  }

 private:
  Image draw(const Scene& scene, const Camera& camera, const Parameters& parameters,
             std::vector<float>* thickness = nullptr) {
    RenderStats stats;
    return find_renderer("auto").draw(scene, camera, parameters, stats, {thickness, nullptr, nullptr},
                                      bench_.session.progress());
  }

  void measure_lengths(const HardCase& hard, const HardView& view, Mode mode, const KnownLengths& known, Worst& worst) {
    Parameters parameters = constant_density(mode, 1.0);
    const Scene scene = make_scene(hard.material, parameters, bench_.session.progress());
    for (const double extinction : hard.extinctions) {
      for (Parameters setting : integrator_settings(constant_density(mode, extinction))) {
        worst.add_length(known.of_optical_depth(extinction, draw(scene, view.camera, setting)));
      }
    }
  }

  void measure_values(const HardCase& hard, Mode mode, Worst& worst) {
    const Parameters parameters = varying_density(mode, hard);
    const Scene scene = make_scene(hard.material, parameters, bench_.session.progress());
    for (const HardView& view : hard.views) {
      JudgedRays judge(scene, view.camera, parameters, beside);
      double& most = view.values_unresolved ? worst.unresolved : worst.values;
      most = std::max(most, judge.error(draw(scene, view.camera, parameters)).nearest);
    }
  }

  // No stage of preprocessing hands on cells that are inside out: what they look like nobody has laid down, but it is
  // colours, from us and from the judge.
  void measure_harm(const HardCase& hard) {
    double most = 0.0;
    for (const Mode mode : {Mode::volume, Mode::volume_surface, Mode::surface, Mode::xray}) {
      const Parameters parameters = varying_density(mode, hard);
      const Scene scene = make_scene(hard.material, parameters, bench_.session.progress());
      for (const HardView& view : hard.views) {
        for (const char* renderer : {"auto", "reference"}) {
          RenderStats stats;
          most = std::max(most, outside_of_colors(find_renderer(renderer).draw(scene, view.camera, parameters, stats,
                                                                               {}, bench_.session.progress())));
        }
      }
    }
    BenchRow row{"error", hard.name, "hard case: " + hard.group, Json::object(), "", std::nullopt, {}, {}, {}};
    row.settings.set("views", hard.views.size());
    row.more = {{"outside_of_colors", most}};
    row.requirements = {
        {"hard cases: cells inside out, channels outside of [0,1] by", closed_form_limit, false, most, ""}};
    bench_.result.add(std::move(row));
    table_.row({hard.group, hard.name, std::to_string(hard.material.mesh.tetrahedra.size()),
                std::to_string(hard.views.size()), "", "", most <= closed_form_limit ? "in [0,1]" : "not colors", ""});
  }

  void report(const HardCase& hard, const Worst& worst) {
    const bool values = hard.known == HardCase::Known::values;
    BenchRow row{"error", hard.name, "hard case: " + hard.group, Json::object(), "", std::nullopt, {}, {}, {}};
    row.settings.set("views", hard.views.size());
    row.more = {{"length_error", worst.length}, {"thickness_error", worst.thickness}};
    if (worst.unresolved > 0.0) row.more.emplace_back("unresolved_error", worst.unresolved);
    row.max_error = values ? Json(worst.values) : Json();
    row.requirements = {
        {"hard cases: length of rays in a constant density, relative, short chords to the roundings granted",
         closed_form_limit, false, std::max(worst.length, worst.thickness), ""}};
    if (values) {
      row.requirements.push_back(
          {"hard cases: closed form, largest error", closed_form_limit, false, worst.values, ""});
    }
    bench_.result.add(std::move(row));
    table_.row({hard.group, hard.name, std::to_string(hard.material.mesh.tetrahedra.size()),
                std::to_string(hard.views.size()), short_number(worst.length), short_number(worst.thickness),
                values ? short_number(worst.values) : "-",
                worst.unresolved > 0.0 ? short_number(worst.unresolved) : ""});
  }

  RenderBench& bench_;
  TextTable table_{{"what is hard", "case", "cells", "views", "length", "thickness", "values", "unresolved"}};
};

}  // namespace

void bench_error_hard_cases(RenderBench& bench) {
  HardCaseTable table(bench);
  const std::vector<HardCase> cases =
      hard_cases([&](std::span<const Vec3> points) { return delaunay_cgal(points, bench.session.progress()); });
  for (const HardCase& hard : cases) {
    const bool quick_one = hard.group == cases.front().group || hard.known == HardCase::Known::nothing;
    if (bench.options.quick && !quick_one) continue;
    table.measure(hard);
  }
  bench.result.tables.push_back(table.take());
}

}  // namespace atomesh::cli
