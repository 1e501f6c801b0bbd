// SPDX-License-Identifier: Apache-2.0
// slf render: images from a circle of viewpoints, from a given camera, or beside a photograph.
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>

#include "tools/camera_file.h"
#include "tools/film.h"
#include "tools/frame_source.h"
#include "tools/mosaic.h"
#include "tools/options.h"
#include "tools/output.h"
#include "tools/render_options.h"
#include "tools/render_scene.h"
#include "tools/text.h"
#include "tools/verb.h"

namespace slf::tools {
namespace {

constexpr std::int64_t kMostSheetSide = 65535, kMostSheetPixels = 1 << 28;  // as of pictures read

/// A view and where it goes.
struct View {
  Camera camera;
  std::string file;
};

/// Before anything is drawn for it.
Outcome check_sheet(int count, int width, int height) {
  const int columns = sheet_columns(count), rows = (count + columns - 1) / columns;
  const std::int64_t wide = std::int64_t{columns} * width, high = std::int64_t{rows} * height;
  if (wide <= kMostSheetSide && high <= kMostSheetSide && wide * high <= kMostSheetPixels)
    return Done{};
  return Failure{kUsage, text("render: a sheet of %d pictures of %d x %d would be an image of %s x "
                              "%s pixels: fewer, or a smaller --size",
                              count, width, height, std::to_string(wide).c_str(),
                              std::to_string(high).c_str())};
}

Result<std::vector<View>, Failure> orbit_views(const RenderOptions& given,
                                               const RenderScene& scene) {
  int width = 800, height = 800;
  if (!given.size.empty()) parse_size(given.size, width, height);
  const int count = std::max(given.orbit, 1);
  if (given.sheet) SLF_CHECK(check_sheet(count, width, height));
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

Outcome report_views(const RenderOptions& given, const std::vector<View>& views,
                     const Rendered& rendered, double prepare, bool partial) {
  auto list = nlohmann::ordered_json::array();
  const std::string frame = given.part.source ? text(", frame %d", given.part.frame) : "";
  for (std::size_t i = 0; i < views.size(); ++i) {
    const View& view = views[i];
    list.push_back({{"camera", view.camera.name},
                    {"file", view.file},
                    {"size", {view.camera.width, view.camera.height}},
                    {"seconds", rendered.seconds[i]}});
    if (!given.common.quiet && !given.common.json)
      std::fprintf(stderr, "%s: %s%s, %d x %d%s, %.3f s\n", output_name(view.file).c_str(),
                   printable(view.camera.name).c_str(), frame.c_str(), view.camera.width,
                   view.camera.height, partial ? ", PARTIAL" : "", rendered.seconds[i]);
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
  return given.film ? given.film->add(image)
                    : save(file, image, given.format.empty() ? "" : "." + given.format);
}

Outcome run_render(RenderOptions& given) {
  SLF_CHECK(check_options(given));
  Capture capture;
  int photo = -1;
  std::vector<View> views;
  if (!given.capture.empty()) {
    // Headers of photographs tell which of them are turned: --pair alone shows one.
    const CaptureOptions cameras{.points = {}, .check_images = given.pair, .cloud = false};
    SLF_TRY(capture, from(given.capture, load_capture(given.capture, cameras)));
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
  return report_views(given, views, rendered, scene->prepare(), scene->partial());
}

/// A film without a choice of frames or of an orbit. Splats stand still, and a part of the bytes is
/// of one light field.
bool shows_all_frames(const RenderOptions& given) {
  return given.part.frames.empty() && given.part.frame < 0 && given.orbit == 0 &&
         given.part.max_bytes == 0 && !is_splat_file(given.input);
}

/// All pictures of the verb as one file, which is written when the last is done.
Outcome run_film(RenderOptions& given) {
  if (!given.part.frames.empty() && given.orbit > 1 && !given.sheet)
    return Failure{kUsage,
                   "render: a film of --frames shows one view: --orbit needs --sheet there"};
  given.film.emplace();
  if (shows_all_frames(given)) {
    SLF_TRY(given.part.frames, all_frames(given.input, given.part, given.limits, given.common));
  }
  std::string number = "%d";  // of a frame: no file has it
  SLF_CHECK(
      for_each_frame("render", ".png", number, given.part, [&] { return run_render(given); }));
  const std::size_t pictures = given.film->size();
  const std::vector<double> times = times_of_last(given.part, pictures);
  FilmTiming timing = timing_of(pictures, times);
  if (!given.film->has_room(timing)) {
    warn(
        "film: frames last unlike long, and it has no room to repeat pictures: it shows each "
        "as long as any other",
        given.common.quiet);
    timing = even_timing(pictures, times);
  }
  const std::vector<std::uint8_t> bytes = given.film->avi(timing);
  return save(given.output, bytes.data(), bytes.size());
}

}  // namespace

void add_render(CLI::App& program, Run& run) {
  auto* verb = program.add_subcommand("render", "Render images or a film from any viewpoint");
  auto o = std::make_shared<RenderOptions>();
  add_render_options(*verb, *o);
  verb->callback([&run, o, verb] {
    o->own_view = verb->count("--orbit") + verb->count("--azimuth") + verb->count("--elevation") +
                      verb->count("--fov") ==
                  0;
    run = [o] {
      if (Film::is_named(o->output)) return run_film(*o);
      return for_each_frame("render", ".png", o->output, o->part, [&] { return run_render(*o); });
    };
  });
}

}  // namespace slf::tools
