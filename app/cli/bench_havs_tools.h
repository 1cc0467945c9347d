// What the parts of bench havs share: ways to draw, a context of their own, the data sets.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "app/cli/bench_render.h"
#include "app/cli/bench_render_tools.h"
#include "app/cli/bench_scenes.h"
#include "render/gl/context.h"
#include "render/gl/volume.h"

namespace atomesh::cli {

inline constexpr std::size_t havs_sample_atoms = 20000;
inline constexpr std::size_t quick_havs_sample_atoms = 2000;  // with --quick

// The data set by name; nothing, and a note, where it cannot be had.
std::optional<BenchScene> havs_bench_scene(RenderBench& bench, const std::string& name);

// Of 0.272 "27.2 %".
std::string percent(double share);
// "512x512"
std::string size_text(const Camera& camera);

// One way of "havs" to draw the volume.
struct Way {
  std::string name;
  Parameters parameters;
  gl::Volume volume;

  Way(std::string n, const Parameters& p) : name(std::move(n)), parameters(p) {}
};

// A context of our own, current as long as this lives.
class HavsBench {
 public:
  explicit HavsBench(RenderBench& bench) : bench_(bench), current_(context_), driver_(gl::current_driver()) {}
  HavsBench(const HavsBench&) = delete;
  HavsBench& operator=(const HavsBench&) = delete;

 protected:
  Progress& progress() { return bench_.session.progress(); }
  void draw(Way& way, const Camera& camera);
  Json settings(const Way& way, const BenchScene& data, const BenchView& view, const Camera& camera) const;
  // "ramps", "exact" or "table"; of `automatic` what the driver takes by itself.
  std::string_view integration_name(HavsIntegration integration) const;

  RenderBench& bench_;
  gl::HeadlessContext context_;
  gl::HeadlessContext::Current current_;
  gl::Driver driver_;
};

}  // namespace atomesh::cli
