// SPDX-License-Identifier: Apache-2.0
// slf render: images from a circle of viewpoints, from a given camera, or beside a photograph.
#include <array>
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>

#include "tools/camera_file.h"
#include "tools/film.h"
#include "tools/frame_source.h"
#include "tools/mosaic.h"
#include "tools/options.h"
#include "tools/output.h"
#include "tools/render_scene.h"
#include "tools/text.h"
#include "tools/verb.h"

namespace slf::tools {
namespace {

struct RenderOptions {
  std::string input, output, camera, capture, image, size, background = "128,128,128";
  int orbit = 0;
  double azimuth = 0, elevation = 20, fov = 30, radius = 0;
  bool own_view = false;  ///< no view was asked for: the file's own, if it has one
  bool sheet = false, pair = false, transparent = false, diffuse_only = false;
  std::optional<Camera> orbit_camera;  ///< of the first frame with points, for all
  std::optional<Film> film;            ///< in place of a picture a file
  PartOptions part;
  LimitOptions limits;
  CommonOptions common;
};

/// A view and where it goes.
struct View {
  Camera camera;
  std::string file;
};

bool parse_background(const std::string& given, std::array<std::uint8_t, 3>& rgb) {
  const char *at = given.data(), *end = at + given.size();
  for (std::size_t c = 0; c < 3; ++c) {
    if (c > 0 && (at == end || *at++ != ',')) return false;
    const auto [stopped, error] = std::from_chars(at, end, rgb[c]);  // refuses beyond 255
    if (error != std::errc()) return false;
    at = stopped;
  }
  return at == end;
}

Result<std::vector<View>, Failure> orbit_views(const RenderOptions& given,
                                               const RenderScene& scene) {
  int width = 800, height = 800;
  if (!given.size.empty()) parse_size(given.size, width, height);
  const int count = std::max(given.orbit, 1);
  std::vector<View> views;
  if (given.own_view)
    if (std::optional<Camera> own = scene.view(width, height))
      return std::vector<View>{{*std::move(own), numbered(given.output, 0)}};
  for (int i = 0; i < count; ++i) {
    const double turn = given.azimuth / 360 + static_cast<double>(i) / count;
    View view{scene.orbit(turn, given.elevation, width, height, given.fov),
              given.sheet ? given.output : numbered(given.output, i)};
    view.camera.name = text("orbit %d of %d", i + 1, count);
    views.push_back(std::move(view));
  }
  return views;
}

View camera_view(const RenderOptions& given, Camera camera) {
  int width = camera.width, height = camera.height;
  if (!given.size.empty()) parse_size(given.size, width, height);
  return {resized(std::move(camera), width, height),
          given.pair ? given.output : numbered(given.output, 0)};
}

RenderSettings settings_of(const RenderOptions& given) {
  RenderSettings settings;
  parse_background(given.background, settings.background);
  if (given.transparent) settings.background = {0, 0, 0};
  settings.radius = given.radius;
  settings.view_dependent = !given.diffuse_only;
  settings.threads = given.common.threads;
  return settings;
}

Outcome check_options(const RenderOptions& given) {
  std::array<std::uint8_t, 3> rgb{};
  int width = 0, height = 0;
  if (!parse_background(given.background, rgb))
    return Failure{kUsage,
                   "render: --background " + given.background + " is not R,G,B of 0 to 255"};
  if (!given.size.empty() && !parse_size(given.size, width, height))
    return Failure{kUsage, "render: --size " + given.size + " is not WxH of 1 to 16384"};
  if (given.capture.empty() != given.image.empty())
    return Failure{kUsage, "render: --capture and --image go together"};
  if (given.pair && (given.capture.empty() || given.transparent))
    return Failure{kUsage, "render: --pair needs --capture and --image, and is not transparent"};
  if (given.sheet && given.transparent)
    return Failure{kUsage, "render: --sheet is not transparent"};
  if (given.common.json && given.output == "-")
    return Failure{kUsage, "render: --json and --output - both want standard output"};
  if (given.transparent && (given.film || small_extension(given.output).starts_with(".jp")))
    return Failure{kUsage, "render: --transparent needs PNG: JPEG has no alpha"};
  constexpr std::array kFormats = {".png", ".jpg", ".jpeg", ".avi"};
  if (given.film) return check_output(given.output);
  if (given.sheet || given.pair) return check_output(given.output, "render", kFormats);
  const std::string first = numbered(given.output, 0);
  if (given.orbit > 1 && first == given.output)
    return Failure{kUsage, "render: --output " + given.output +
                               " is neither a directory nor has a %d for the view's number"};
  if (given.output.ends_with('/')) SLF_CHECK(make_directory(given.output));
  return check_output(first, "render", kFormats);
}

struct Rendered {
  std::vector<Image> images;
  std::vector<double> seconds;
};

Rendered render_views(const RenderOptions& given, const RenderScene& scene,
                      const std::vector<View>& views) {
  Rendered out;
  for (const View& view : views) {
    Stopwatch watch;
    const Rendering rendering = scene.render(view.camera);
    out.seconds.push_back(watch.lap());
    out.images.push_back(given.transparent ? transparent(rendering) : rendering.image);
  }
  return out;
}

Outcome report(const RenderOptions& given, const std::vector<View>& views, const Rendered& rendered,
               double prepare, bool partial) {
  auto list = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < views.size(); ++i) {
    const View& view = views[i];
    list.push_back({{"camera", view.camera.name},
                    {"file", view.file},
                    {"size", {view.camera.width, view.camera.height}},
                    {"seconds", rendered.seconds[i]}});
    if (!given.common.quiet && !given.common.json)
      std::fprintf(stderr, "%s: %s, %d x %d%s, %.3f s\n", output_name(view.file).c_str(),
                   printable(view.camera.name).c_str(), view.camera.width, view.camera.height,
                   partial ? ", PARTIAL" : "", rendered.seconds[i]);
  }
  if (!given.common.json) return Done{};
  return print(
      nlohmann::ordered_json{{"seconds_prepare", prepare}, {"partial", partial}, {"images", list}});
}

/// The photograph of the view, on the background and of the view's size.
Result<Image, Failure> photograph(const RenderOptions& given, const Capture& capture, int camera,
                                  const View& view) {
  SLF_TRY(const Image image, from(given.capture, load_image(capture, camera)));
  if (image.width != view.camera.width || image.height != view.camera.height)
    return Failure{kUsage,
                   "render: --pair and another --size than the photograph's do not go together"};
  std::array<std::uint8_t, 3> background{};
  parse_background(given.background, background);
  return opaque(image, background);
}

Outcome keep(RenderOptions& given, const std::string& file, const Image& image) {
  return given.film ? given.film->add(image) : save(file, image);
}

Outcome run_render(RenderOptions& given) {
  SLF_CHECK(check_options(given));
  Capture capture;
  int photo = -1;
  std::vector<View> views;
  if (!given.capture.empty()) {
    SLF_TRY(capture, from(given.capture,
                          load_capture(given.capture, {.points = {}, .check_images = false})));
    SLF_TRY(photo, find_camera(capture, given.image, given.capture));
    views.push_back(camera_view(
        given, moved(capture.cameras[static_cast<std::size_t>(photo)], capture.origin)));
  } else if (!given.camera.empty()) {
    SLF_TRY(Camera camera, read_camera(given.camera));
    views.push_back(camera_view(given, std::move(camera)));
  }
  const RenderSettings settings = settings_of(given);
  SLF_TRY(const auto scene,
          RenderScene::load(given.input, settings, given.part, given.limits, given.common));
  if (views.empty()) {
    SLF_TRY(views, orbit_views(given, *scene));
    if (given.part.source) {  // frames: the camera stands
      if (!given.orbit_camera && !scene->is_empty()) given.orbit_camera = views[0].camera;
      if (given.orbit_camera) views[0].camera = *given.orbit_camera;
    }
  }
  Rendered rendered = render_views(given, *scene, views);
  if (given.pair) {
    SLF_TRY(const Image left, photograph(given, capture, photo, views[0]));
    SLF_CHECK(
        keep(given, given.output, mosaic({left, rendered.images[0]}, 2, settings.background)));
  } else if (given.sheet) {
    const int columns = sheet_columns(static_cast<int>(views.size()));
    SLF_CHECK(keep(given, given.output, mosaic(rendered.images, columns, settings.background)));
  } else {
    for (std::size_t i = 0; i < views.size(); ++i)
      SLF_CHECK(keep(given, views[i].file, rendered.images[i]));
  }
  return report(given, views, rendered, scene->prepare(), scene->partial());
}

/// All pictures of the verb as one file, which is written when the last is done.
Outcome run_film(RenderOptions& given) {
  if (!given.part.frames.empty() && given.orbit > 1 && !given.sheet)
    return Failure{kUsage,
                   "render: a film of --frames shows one view: --orbit needs --sheet there"};
  given.film.emplace();
  std::string number = "%d";  // of a frame: no file has it
  SLF_CHECK(for_each_frame("render", number, given.part, [&] { return run_render(given); }));
  const double rate = pictures_a_second(given.part, given.film->size());
  const std::vector<std::uint8_t> bytes = given.film->avi(rate);
  return save(given.output, bytes.data(), bytes.size());
}

void add_view_options(CLI::App& verb, RenderOptions& o) {
  const char* group = "Views (default: the file's own view, else one of an orbit)";
  auto* orbit = verb.add_option("--orbit", o.orbit, "N views on a circle around the cloud")
                    ->check(whole_range(1, 1000));
  auto* camera =
      verb.add_option("--camera", o.camera,
                      "cameras.json:NAME or cameras.json:INDEX; cameras.json alone: its first")
          ->type_name("FILE[:WHICH]")
          ->excludes(orbit);
  auto* capture = verb.add_option("--capture", o.capture, "A capture, for --image")
                      ->type_name("DIR")
                      ->excludes(orbit)
                      ->excludes(camera);
  auto* image =
      verb.add_option("--image", o.image, "Name (or index) of the capture's image to render")
          ->type_name("NAME");
  auto* pair = verb.add_flag("--pair", o.pair, "Photograph and rendering side by side");
  auto* sheet = verb.add_flag("--sheet", o.sheet, "All views of the orbit in one image");
  auto* azimuth = verb.add_option("--azimuth", o.azimuth, "Of the orbit's first view, degrees")
                      ->capture_default_str()
                      ->check(range(-360, 360));
  auto* elevation =
      verb.add_option("--elevation", o.elevation, "Of the orbit, degrees above the horizon")
          ->capture_default_str()
          ->check(range(-90, 90));
  auto* fov = verb.add_option("--fov", o.fov, "Field of view of the orbit's cameras, degrees")
                  ->capture_default_str()
                  ->check(range(1, 170));
  for (CLI::Option* option : {orbit, camera, capture, image, pair, sheet, azimuth, elevation, fov})
    option->group(group);
}

}  // namespace

void add_render(CLI::App& program, Run& run) {
  auto* verb = program.add_subcommand("render", "Render images (PNG) from any viewpoint");
  auto o = std::make_shared<RenderOptions>();
  verb->add_option("FILE", o->input,
                   "The .slf file, or Gaussian splats (PLY, SPZ, splat, ksplat, glTF); - is a .slf "
                   "on standard input")
      ->type_name("")
      ->required();
  verb->add_option(
          "-o,--output", o->output,
          "PNG; - is standard output. A directory, or %d or %03d in the name, has the number of "
          "the view. x.avi: all views or frames as a film, Motion JPEG")
      ->required()
      ->type_name("FILE");
  add_view_options(*verb, *o);
  verb->add_option("--size", o->size, "Pixels, WxH; default: 800x800, or the camera's own")
      ->type_name("WxH");
  verb->add_option("--background", o->background, "R,G,B, each 0 to 255")
      ->type_name("R,G,B")
      ->capture_default_str();
  verb->add_flag("--transparent", o->transparent, "No background: coverage becomes alpha");
  verb->add_flag("--diffuse-only", o->diffuse_only,
                 "Mean colours, without what depends on the view");
  verb->add_option("--radius", o->radius, "Of a surfel, voxels; 0: from the points' spacing")
      ->capture_default_str()
      ->check(range(0, 1000));
  add_part(*verb, o->part);
  add_frames_to_show(*verb, o->part);
  add_limits(*verb, o->limits);
  add_threads(*verb, o->common);
  add_quiet(*verb, o->common);
  add_json(*verb, o->common);
  verb->callback([&run, o, verb] {
    o->own_view = verb->count("--orbit") + verb->count("--azimuth") + verb->count("--elevation") +
                      verb->count("--fov") ==
                  0;
    run = [o] {
      if (Film::is_named(o->output)) return run_film(*o);
      return for_each_frame("render", o->output, o->part, [&] { return run_render(*o); });
    };
  });
}

}  // namespace slf::tools
