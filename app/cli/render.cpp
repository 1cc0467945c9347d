// atomesh render FILE -o IMG.png: one picture, with what made it inside the file.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>

#include "app/cli/channel_files.h"
#include "app/cli/commands.h"
#include "app/cli/extinction_note.h"
#include "app/cli/load_material.h"
#include "app/cli/machine.h"
#include "app/cli/output_file.h"
#include "app/cli/parameter_text.h"
#include "app/cli/picture_comparison.h"
#include "app/cli/picture_text.h"
#include "app/cli/pipeline_options.h"
#include "app/cli/render_legend.h"
#include "app/cli/render_picture.h"
#include "app/cli/session.h"
#include "app/cli/text_table.h"
#include "app/cli/text_values.h"
#include "app/gui/scalar_histogram.h"
#include "core/camera.h"
#include "core/error.h"
#include "core/image.h"
#include "render/renderer.h"
#include "render/scene.h"

namespace atomesh::cli {
namespace {

// Why the picture will show nothing but its background.
std::string nothing_to_draw(const Material& material, const Parameters& parameters) {
  const bool cut = std::any_of(parameters.cut_planes.begin(), parameters.cut_planes.end(),
                               [](const CutPlane& plane) { return plane.enabled; });
  if (parameters.mode == Mode::atoms) {
    return cut ? "the picture is empty: no visible atom satisfies the cut planes"
               : "the picture is empty: no atom is visible";
  }
  if (cut) return "the picture is empty: no tetrahedron satisfies the cut planes with all its corners";
  if (material.atoms.size() == 0) return "the picture is empty: the mesh has no tetrahedra";
  return fmt::format("the picture is empty: the {} atoms span no volume; --mode atoms shows them",
                     material.atoms.size());
}

struct RenderArguments {
  std::string input;
  std::string output;
  std::string mode;
  std::string size = "800x600";
  std::string parameter_file;
  std::vector<std::string> settings;
  std::string view;
  std::string renderer = "auto";
  std::string reference;
  double tolerance = 0.0;
  bool transparent = false;
  std::vector<std::string> channels;
  std::string histogram;
  LegendOptions legend;
  PictureOptions picture;
  bool help_parameters = false;
  std::string field;
  MeshFileOptions mesh;
  PipelineOptions options;
};

// The defaults, then the file, then --mode and --view, then each --set: the more particular wins.
Parameters chosen_parameters(const RenderArguments& arguments) {
  Parameters parameters;
  if (!arguments.parameter_file.empty()) parameters = read_parameters(arguments.parameter_file);
  if (!arguments.mode.empty()) parameters.mode = mode_from_name(arguments.mode);
  if (!arguments.view.empty()) set_view(parameters, arguments.view);
  for (const std::string& setting : arguments.settings) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos) {
      throw UsageError("--set: expected key=value, got \"" + setting +
                       "\"; put FILE before --set, and see --help-parameters for the keys");
    }
    set_parameter(parameters, setting.substr(0, equals), std::string_view(setting).substr(equals + 1));
  }
  if (!arguments.field.empty()) set_parameter(parameters, "volume.field", arguments.field);
  if (arguments.transparent) parameters.background.a = 0.0F;
  return parameters;
}

std::string difference_path(const std::string& output) {
  std::filesystem::path path(output);
  path.replace_filename(path.stem().string() + "-difference.png");
  return path.string();
}

int run_render(const RenderArguments& arguments, const CLI::App& app, Session& session) {
  if (arguments.help_parameters) {
    session.print_text(parameter_documentation());
    return exit_done;
  }
  if (arguments.input.empty()) throw UsageError("render: expected FILE, a .crb or .crt, a mesh or an atoms file");
  if (arguments.output.empty()) throw UsageError("render: expected -o IMG.png");
  check_output(arguments.output, {".png"});
  if (!arguments.reference.empty()) {
    std::error_code ignored;
    if (std::filesystem::equivalent(arguments.reference, arguments.output, ignored) ||
        writes_level(arguments.reference, arguments.output, arguments.picture)) {
      throw UsageError("--reference " + arguments.reference +
                       ": is a picture that -o or --keep-levels writes; they would always agree");
    }
    if (!std::filesystem::exists(arguments.reference)) {
      throw InputError(arguments.reference, 0, "does not exist; expected the picture to compare with");
    }
  }
  if (!arguments.histogram.empty()) check_output(arguments.histogram, {".csv"});
  const auto [width, height] = parse_size(arguments.size);
  const Parameters parameters = chosen_parameters(arguments);
  const Renderer& renderer = find_renderer(arguments.renderer);
  ChannelFiles channel_files(arguments.channels, parameters.mode);

  using clock = std::chrono::steady_clock;
  const auto elapsed_since = [](clock::time_point since) {
    return std::chrono::duration<double, std::milli>(clock::now() - since).count();
  };
  const auto start = clock::now();
  MaterialParts parts = parts_needed(parameters);
  if (!arguments.histogram.empty()) parts.tetrahedra = parts.defects = parts.fields = true;
  const LoadedMaterial loaded = load_material(arguments.input, parts, app, arguments.options, session, arguments.mesh);
  for (const std::string& setting : arguments.settings) {
    check_species_key(setting.substr(0, setting.find('=')), loaded.material.atoms);
  }

  if (!arguments.histogram.empty()) {
    gui::write_histogram_csv(arguments.histogram, gui::scalar_histogram(loaded.material, parameters.volume,
                                                                        gui::default_bins, session.progress()));
  }

  const auto scene_start = clock::now();
  const Scene scene = make_scene(loaded.material, parameters, session.progress());
  const double scene_ms = elapsed_since(scene_start);
  if (scene.tetrahedra.empty() && scene.surface.empty() && scene.balls.empty()) {
    session.note(nothing_to_draw(loaded.material, parameters));
  }
  if (loaded.material.atoms.size() == 0) {
    const std::string note = extinction_note(scene, parameters);
    if (!note.empty()) session.note(note);
  }
  const Camera camera = make_camera(parameters, scene.bounds, width, height);
  PictureLegend legend(arguments.legend, parameters.mode);
  const PictureReport drawn =
      draw_picture({renderer, loaded.material, scene, camera, parameters, arguments.output,
                    picture_text(arguments.output, arguments.input, hash_of_data(arguments.input, session.progress()),
                                 loaded.material, parameters, renderer.name(),
                                 {.legend = arguments.legend.legend,
                                  .scale_bar = arguments.legend.scale_bar,
                                  .tripod = arguments.legend.tripod})},
                   arguments.picture, channel_files, legend, session);
  const RenderStats& stats = drawn.stats;
  const double total_ms = elapsed_since(start);

  session.print("{}: {}, renderer {}, {}x{}{}; load {} ms, setup {} ms, render {} ms, total {} ms", arguments.output,
                mode_name(parameters.mode), renderer.name(), width, height, drawn.summary, milliseconds(loaded.ms),
                milliseconds(scene_ms + stats.setup_ms), milliseconds(stats.render_ms), milliseconds(total_ms));
  Json json = Json::object({{"mode", mode_name(parameters.mode)},
                            {"renderer", renderer.name()},
                            {"size", Json::array({width, height})},
                            {"ms", Json::object({{"load", loaded.ms},
                                                 {"setup", scene_ms + stats.setup_ms},
                                                 {"render", stats.render_ms},
                                                 {"total", total_ms}})},
                            {"tetrahedra", scene.tetrahedra.size()},
                            {"triangles", scene.surface.size()},
                            {"atoms", loaded.material.atoms.size()},
                            {"steps", stats.steps},
                            {"peak_memory_mb", peak_memory_mb()},
                            {"output", Json::object({{"file", arguments.output},
                                                     {"bytes", std::filesystem::file_size(arguments.output)}})}});
  legend.add_to(json);
  if (!drawn.passes.null()) json.set("passes", drawn.passes);
  if (!drawn.progressive.null()) json.set("progressive", drawn.progressive);
  int exit_code = exit_done;
  if (!arguments.reference.empty()) {
    const PictureComparison comparison = compare_pictures(arguments.output, arguments.reference, arguments.tolerance,
                                                          difference_path(arguments.output), false, session);
    json.set("reference", comparison.json);
    if (!comparison.passed) exit_code = exit_comparison_failed;
  }
  session.write_json(json);
  return exit_code;
}

}  // namespace

Command add_render(CLI::App& app) {
  auto arguments = std::make_shared<RenderArguments>();
  app.add_option("FILE", arguments->input,
                 "A .crb or .crt, a mesh file (.vtu, .vtk, PLOT3D, TetGen), or an atoms file to preprocess on the way");
  app.add_option("-o,--output", arguments->output, "The picture to write")->type_name("IMG.png");
  app.add_option("--mode", arguments->mode, "volume-surface, volume, surface, xray or atoms [volume-surface]")
      ->type_name("MODE");
  app.add_option("--size", arguments->size, "Pixels")->type_name("WxH")->capture_default_str();
  app.add_option("--params", arguments->parameter_file,
                 "Display and rendering parameters: of a .crf, or of a picture that atomesh made")
      ->type_name("F.crf|IMG.png");
  app.add_option("--set", arguments->settings, "Set parameters; later ones win, and all win over --params")
      ->type_name("KEY=VALUE…");
  app.add_option("--view", arguments->view,
                 "front, back, left, right, top, bottom, iso or AZIMUTH,ELEVATION in degrees")
      ->type_name("VIEW");
  app.add_option("--renderer", arguments->renderer,
                 "auto, cpu, havs (OpenGL; mode volume), or reference: the judge, exact and slow")
      ->type_name("NAME")
      ->capture_default_str();
  app.add_option("--field", arguments->field, "The scalar that the volume shows, as --set volume.field=NAME")
      ->type_name("NAME");
  add_mesh_options(app, arguments->mesh);
  app.add_flag("--transparent", arguments->transparent, "Leave the background transparent");
  app.add_option("--channel", arguments->channels,
                 "Also write numbers per pixel: thickness (Å, mode xray), depth (Å) or id (modes surface, atoms)")
      ->type_name("NAME=FILE.npy");
  app.add_option("--histogram", arguments->histogram,
                 "Also count the scalars that mode volume shows, in 256 intervals: scalar and value from and to, count")
      ->type_name("FILE.csv");
  add_legend_options(app, arguments->legend);
  add_picture_options(app, arguments->picture);
  app.add_option("--reference", arguments->reference,
                 "Compare the picture with this one; where they differ, exit with 4 and leave IMG-difference.png")
      ->type_name("IMG");
  app.add_option_function<std::string>(
         "--tolerance", [arguments](const std::string& text) { arguments->tolerance = parse_tolerance(text); },
         "With --reference: largest channel difference that still passes, 0 to 1 or as 2/255 [0]")
      ->type_name("E");
  app.add_flag("--help-parameters", arguments->help_parameters, "Explain every parameter of --set and .crf, and exit");
  add_pipeline_options(app, arguments->options, "--site-tolerance");
  app.footer(
      "Example:\n"
      "  atomesh render nacl.crb -o nacl.png --mode volume-surface --view iso --set volume_surface.face_alpha=0.3\n"
      "  atomesh render nacl.dat -o atoms.png --mode atoms --size 1920x1080\n"
      "  atomesh render nacl.crb -o again.png --params nacl.png --size 3840x2160   # the view of another picture\n"
      "  atomesh render combxyz.bin -o comb.png --mode volume --field Density --set volume.alpha_length=0.5\n");
  return [arguments, &app](Session& session) { return run_render(*arguments, app, session); };
}

}  // namespace atomesh::cli
