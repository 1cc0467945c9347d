#include "app/cli/bench_havs_tools.h"

#include <fmt/format.h>

#include "core/error.h"

namespace atomesh::cli {

std::optional<BenchScene> havs_bench_scene(RenderBench& bench, const std::string& name) {
  bench.session.progress().stage(name);
  try {
    return make_bench_scene(name, bench.options.data, bench.options.quick ? quick_havs_sample_atoms : havs_sample_atoms,
                            bench.session.progress());
  } catch (const UnavailableError& error) {
    bench.session.note(error.what());
    return std::nullopt;
  }
}

std::string percent(double share) {
  return fmt::format("{:.1f} %", 100.0 * share);
}

std::string size_text(const Camera& camera) {
  return fmt::format("{}x{}", camera.width, camera.height);
}

void HavsBench::draw(Way& way, const Camera& camera) {
  RenderStats stats;
  way.volume.draw(camera, way.parameters, whole_picture(camera), {}, stats, progress());
}

Json HavsBench::settings(const Way& way, const BenchScene& data, const BenchView& view, const Camera& camera) const {
  return Json::object({{"mode", "volume"},
                       {"map", data.volume_map},
                       {"view", view.name},
                       {"projection", camera.projection == Projection::parallel ? "parallel" : "perspective"},
                       {"size", Json::array({camera.width, camera.height})},
                       {"renderer", "havs"},
                       {"integration", integration_name(way.parameters.havs.integration)},
                       {"opengl", driver_.renderer}});
}

std::string_view HavsBench::integration_name(HavsIntegration integration) const {
  if (integration == HavsIntegration::automatic) return driver_.software ? "ramps" : "table";
  return integration == HavsIntegration::exact ? "exact" : "table";
}

}  // namespace atomesh::cli
