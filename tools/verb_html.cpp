// SPDX-License-Identifier: Apache-2.0
// slf html: one page with a file, the decoder and the viewer in it, opened by a double click.
#include <array>
#include <filesystem>
#include <memory>

#include "slf/gaussian_renderer.h"
#include "slf/jpeg.h"
#include "slf/render.h"
#include "tools/camera_file.h"
#include "tools/given_poster.h"
#include "tools/html_page.h"
#include "tools/notes_input.h"
#include "tools/options.h"
#include "tools/output.h"
#include "tools/page_template.h"
#include "tools/stream_input.h"
#include "tools/text.h"
#include "tools/verb.h"

namespace slf::tools {
namespace {

constexpr int kPosterPixels = 480;
// As base64 that is two thirds of the longest text that browsers hold, 2^29 characters.
constexpr std::uint64_t kMostFileBytes = std::uint64_t{1} << 28;
// The viewer's own by day and by night: `paper` and `slate` of web/viewer/options.js.
constexpr const char *kPaper = "f3f1ec", *kSlate = "191a1d";

struct HtmlOptions {
  std::string input, output, title, camera, poster, background, notes;
  bool own_view = false;  ///< no view was asked for: the file's own, if it has one
  double azimuth = 30, elevation = 20, fov = 30, autorotate = 0, speed = 1;
  double metres_per_unit = 0;  ///< 0: what the file says
  bool no_poster = false, no_loop = false, paused = false;
  LimitOptions limits;
  CommonOptions common;
};

/// RRGGBB, with or without a #.
bool parse_colour(std::string_view given, std::array<std::uint8_t, 3>& rgb) {
  if (!given.empty() && given[0] == '#') given.remove_prefix(1);
  if (given.size() != 6 || given.find_first_not_of("0123456789abcdefABCDEF") != given.npos)
    return false;
  const unsigned long value = std::stoul(std::string(given), nullptr, 16);
  rgb = {std::uint8_t(value >> 16), std::uint8_t(value >> 8 & 255), std::uint8_t(value & 255)};
  return true;
}

Outcome check_options(const HtmlOptions& given) {
  std::array<std::uint8_t, 3> rgb{};
  if (!given.background.empty() && !parse_colour(given.background, rgb))
    return Failure{kUsage, "html: --background " + given.background + " is not RRGGBB"};
  if (given.no_poster && !given.poster.empty())
    return Failure{kUsage, "html: --poster and --no-poster do not go together"};
  if (given.common.json && given.output == "-")
    return Failure{kUsage, "html: --json and --output - both want standard output"};
  if (page_template().empty())
    return Failure{kUnsupported,
                   "html: this program was built without the viewer page web/dist/one_file.html; "
                   "run npm ci && npm run build in web/, then build slf again"};
  return check_output(given.output, "html", std::array{".html", ".htm"});
}

std::string title_of(const HtmlOptions& given, const Metadata& metadata) {
  if (!given.title.empty()) return given.title;
  if (std::string title = page_title(metadata); !title.empty()) return title;
  return given.input == "-" ? "Surface light field"
                            : std::filesystem::path(given.input).stem().string();
}

/// The part of the camera's picture that a square poster shows, which is where the viewer starts.
Camera square(Camera camera) {
  const int side = std::min(camera.width, camera.height);
  camera.cx -= (camera.width - side) / 2.0;
  camera.cy -= (camera.height - side) / 2.0;
  camera.width = camera.height = side;
  return resized(std::move(camera), kPosterPixels, kPosterPixels);
}

/// The first view by the renderer of points or that of splats.
template <class Drawn, class Of>
Image first_view(const Of& of, const HtmlOptions& given, const std::optional<Camera>& camera,
                 const RenderSettings& settings) {
  const Drawn renderer(of, settings);
  const Camera view = camera ? square(*camera)
                             : renderer.orbit(given.azimuth / 360, given.elevation, kPosterPixels,
                                              kPosterPixels, given.fov);
  return renderer.render(view).image;
}

/// The first view on the background that was chosen, else on those of day and night.
/// @param draw  takes settings, gives a picture
template <class Draw>
Result<Posters, Failure> posters_by(const HtmlOptions& given, const Draw& draw) {
  RenderSettings settings;
  settings.threads = given.common.threads;
  const auto rendered = [&](const std::string& background) -> Result<std::string, Failure> {
    parse_colour(background, settings.background);
    SLF_TRY(const auto jpeg, from(std::string(), encode_jpeg(draw(settings), kPosterQuality)));
    return "data:image/jpeg;base64," + base64(jpeg.data(), jpeg.size());
  };
  Posters posters;
  SLF_TRY(posters.day, rendered(given.background.empty() ? kPaper : given.background));
  if (given.background.empty()) {
    SLF_TRY(posters.night, rendered(kSlate));
  }
  return posters;
}

Result<Posters, Failure> rendered_posters(const HtmlOptions& given, const LightField& field,
                                          const std::optional<Camera>& camera) {
  if (has_gaussians(field.header)) {
    SLF_TRY(const Gaussians splats, from(given.input, gaussians_of(field, given.common.threads)));
    return posters_by(given, [&](const RenderSettings& settings) {
      return first_view<GaussianRenderer>(splats, given, camera, settings);
    });
  }
  const ViewMaps maps(field, given.common.threads);
  return posters_by(given, [&](const RenderSettings& settings) {
    return first_view<Renderer>(maps, given, camera, settings);
  });
}

nlohmann::ordered_json page_options(const HtmlOptions& given, const std::string& title,
                                    const std::optional<Camera>& camera, const std::string& notes) {
  nlohmann::ordered_json options{{"title", title},
                                 {"azimuth", given.azimuth},
                                 {"elevation", given.elevation},
                                 {"fov", given.fov}};
  if (!given.background.empty()) options["background"] = given.background;
  if (given.autorotate != 0) options["autorotate"] = given.autorotate;
  if (camera) options["view"] = view_json(*camera);
  if (given.speed != 1) options["speed"] = given.speed;
  if (given.no_loop) options["loop"] = false;
  if (given.paused) options["paused"] = true;
  if (given.metres_per_unit > 0) options["metres"] = given.metres_per_unit;
  if (!notes.empty()) options["notes"] = nlohmann::ordered_json::parse(notes);
  return options;
}

/// Refuses what no browser would open.
Outcome check_file_bytes(const std::string& name, std::uint64_t bytes) {
  if (bytes <= kMostFileBytes) return Done{};
  return Failure{kLimitExceeded, name + ": its " + grouped(bytes) + " bytes are more than the " +
                                     grouped(kMostFileBytes) +
                                     " that one page holds; web/viewer shows a file beside a page"};
}

Outcome run_html(const HtmlOptions& given) {
  SLF_CHECK(check_options(given));
  std::error_code none;
  const std::uintmax_t size = std::filesystem::file_size(given.input, none);
  if (!none) SLF_CHECK(check_file_bytes(given.input, size));
  std::optional<Camera> camera;
  if (!given.camera.empty()) {
    SLF_TRY(camera, read_camera(given.camera));
  }
  std::string notes;
  if (!given.notes.empty()) {
    SLF_TRY(notes, read_notes(given.notes));
  }
  const std::string name = input_name(given.input);
  LimitOptions limits = given.limits;
  limits.limits.max_stream_bytes = kMostFileBytes;
  SLF_TRY(const StreamFile input, read_stream(given.input, limits, given.common));
  SLF_CHECK(check_frames(given.input, input, limits));
  const std::vector<std::uint8_t>& stream = input.bytes;
  const DecodeOptions options = decode_options(input.info, {}, given.limits, given.common);
  auto decoded = decode(stream, options);
  if (!decoded) return decode_failure(name, decoded.error(), input, options);
  const LightField& field = *decoded;
  SLF_CHECK(require_view_maps(field, given.input));
  if (given.own_view)
    camera = named_view(input.info.metadata, field.header.up, kPosterPixels, kPosterPixels);
  Posters poster;
  if (!given.poster.empty()) {
    SLF_TRY(poster.day, given_poster(given.poster));
  } else if (!given.no_poster) {
    SLF_TRY(poster, rendered_posters(given, field, camera));
  }
  const std::string title = title_of(given, input.info.metadata);
  const std::string page = html_page(page_template(), title, poster,
                                     page_options(given, title, camera, notes), stream);
  SLF_CHECK(save(given.output, page));
  if (given.common.json)
    return print(nlohmann::ordered_json{{"bytes", page.size()},
                                        {"file", base64_size(stream.size())},
                                        {"poster", poster.day.size() + poster.night.size()},
                                        {"partial", field.partial}});
  if (!given.common.quiet)
    std::fprintf(stderr, "%s: %s bytes, %s of them the file\n", output_name(given.output).c_str(),
                 grouped(page.size()).c_str(), grouped(base64_size(stream.size())).c_str());
  return Done{};
}

void add_notes(CLI::App& verb, HtmlOptions& o) {
  verb.add_option("--notes", o.notes,
                  "Points with text and guided tours (JSON, docs/notes.md), checked; default: "
                  "those of the file's metadata")
      ->type_name("FILE");
  verb.add_option("--metres-per-unit", o.metres_per_unit,
                  "Metres in a unit of the world, by which the page measures; default: the file's")
      ->type_name("")
      ->check(range(1e-12, 1e12));
}

}  // namespace

void add_html(CLI::App& program, Run& run) {
  auto* verb =
      program.add_subcommand("html", "One web page with the file, the decoder and a viewer in it");
  auto o = std::make_shared<HtmlOptions>();
  verb->add_option("FILE", o->input, "The .slf file; - is standard input")
      ->type_name("")
      ->required();
  verb->add_option("-o,--output", o->output, "The page (HTML); - is standard output")
      ->required()
      ->type_name("FILE");
  verb->add_option("--title", o->title, "Title of the page; default: the file's own, else its name")
      ->type_name("TEXT");
  auto* camera =
      verb->add_option(
              "--camera", o->camera,
              "First view: cameras.json:NAME or cameras.json:INDEX; cameras.json alone: its first. "
              "Default: the file's own view, else one of an orbit")
          ->type_name("FILE[:WHICH]");
  for (auto* option :
       {verb->add_option("--azimuth", o->azimuth, "Azimuth of the first view, degrees")
            ->check(range(-360, 360)),
        verb->add_option("--elevation", o->elevation,
                         "Elevation of the first view, degrees above the horizon")
            ->check(range(-90, 90)),
        verb->add_option("--fov", o->fov, "Field of view, degrees")->check(range(1, 170))})
    option->capture_default_str()->excludes(camera);
  verb->add_option("--autorotate", o->autorotate,
                   "Degrees a second until somebody takes hold; 0: still")
      ->capture_default_str()
      ->check(range(-90, 90));
  verb->add_option("--speed", o->speed, "Speed of a light field that moves; 1: as the file has it")
      ->capture_default_str()
      ->check(range(1.0 / 16, 16));
  verb->add_flag("--no-loop", o->no_loop, "What moves plays once");
  verb->add_flag("--paused", o->paused, "What moves stands still until somebody plays it");
  verb->add_option("--background", o->background,
                   "RRGGBB; default: light by day and dark by night, as the reader's device has it")
      ->type_name("RRGGBB");
  add_notes(*verb, *o);
  verb->add_option("--poster", o->poster,
                   "PNG, JPEG or PPM that shows until the file is decoded; default: the first view")
      ->type_name("FILE");
  verb->add_flag("--no-poster", o->no_poster, "A smaller page, empty until the file is decoded");
  add_limits(*verb, o->limits);
  add_threads(*verb, o->common);
  add_quiet(*verb, o->common);
  add_json(*verb, o->common);
  verb->callback([&run, o, verb] {
    o->own_view = verb->count("--camera") + verb->count("--azimuth") + verb->count("--elevation") +
                      verb->count("--fov") ==
                  0;
    run = [o] { return run_html(*o); };
  });
}

}  // namespace slf::tools
