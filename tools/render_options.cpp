// SPDX-License-Identifier: Apache-2.0
#include "tools/render_options.h"

#include <array>
#include <charconv>

#include "tools/output.h"

namespace slf::tools {
namespace {

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
  auto* azimuth =
      verb.add_option("--azimuth", o.azimuth, "Azimuth of the orbit's first view, degrees")
          ->capture_default_str()
          ->check(range(-360, 360));
  auto* elevation = verb.add_option("--elevation", o.elevation,
                                    "Elevation of the orbit, degrees above the horizon")
                        ->capture_default_str()
                        ->check(range(-90, 90));
  auto* fov = verb.add_option("--fov", o.fov, "Field of view of the orbit's cameras, degrees")
                  ->capture_default_str()
                  ->check(range(1, 170));
  for (CLI::Option* of_orbit : {sheet, azimuth, elevation, fov})
    of_orbit->excludes(camera)->excludes(capture);
  for (CLI::Option* option : {orbit, camera, capture, image, pair, sheet, azimuth, elevation, fov})
    option->group(group);
}

Outcome check_picture(const RenderOptions& given, const std::string& file) {
  if (given.format == "png")
    return check_output(file, "render --format png", std::array{".png"}, FormatBy::kOption);
  if (given.format == "jpg")
    return check_output(file, "render --format jpg", std::array{".jpg", ".jpeg"},
                        FormatBy::kOption);
  return check_output(file, "render", std::array{".png", ".jpg", ".jpeg", ".avi"});
}

}  // namespace

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
  const std::string format =
      given.format.empty() ? small_extension(given.output) : "." + given.format;
  if (given.film && !given.format.empty())
    return Failure{kUsage, "render: --format is of pictures, and " + given.output + " is a film"};
  if (given.transparent && (given.film || format.starts_with(".jp")))
    return Failure{kUsage, "render: --transparent needs PNG: JPEG has no alpha"};
  if (given.film) return check_output(given.output, "render", std::array{".avi"});
  if (given.sheet || given.pair) return check_picture(given, given.output);
  const std::string first = numbered(given.output, 0);
  if (given.orbit > 1 && first == given.output && !given.part.frames.empty())
    return Failure{kUsage,
                   "render: --output of --frames and --orbit needs a %d for the frame and one for "
                   "the view"};
  if (given.orbit > 1 && first == given.output)
    return Failure{kUsage, "render: --output " + given.output +
                               " is neither a directory nor has a %d for the view's number"};
  if (given.output.ends_with('/')) SLF_CHECK(make_directory(given.output));
  return check_picture(given, first);
}

void add_render_options(CLI::App& verb, RenderOptions& o) {
  verb.add_option("FILE", o.input,
                  "The .slf file, or Gaussian splats (PLY, SPZ, SOG, splat, ksplat, glTF); - is a "
                  ".slf on standard input")
      ->type_name("")
      ->required();
  verb.add_option(
          "-o,--output", o.output,
          "PNG, or JPEG for x.jpg; - is standard output, PNG. A directory, or %d or %03d in the "
          "name, has the number of the view. x.avi: a film, Motion JPEG, of all frames of a file "
          "that moves, those of --frames, or the views of --orbit")
      ->required()
      ->type_name("FILE");
  verb.add_option("--format", o.format, "In place of the name's extension")
      ->type_name("")
      ->check(CLI::IsMember({"png", "jpg"}));
  add_view_options(verb, o);
  verb.add_option("--size", o.size, "Pixels, WxH; default: 800x800, or the camera's own")
      ->type_name("WxH");
  verb.add_option("--background", o.background, "R,G,B, each 0 to 255")
      ->type_name("R,G,B")
      ->capture_default_str();
  verb.add_flag("--transparent", o.transparent, "No background: coverage becomes alpha");
  verb.add_flag("--diffuse-only", o.diffuse_only, "Mean colours, without what depends on the view");
  verb.add_option("--radius", o.radius, "Radius of a surfel, voxels; 0: from the points' spacing")
      ->capture_default_str()
      ->check(range(0, 1000));
  add_part(verb, o.part);
  add_frames_to_show(verb, o.part);
  add_limits(verb, o.limits);
  add_threads(verb, o.common);
  add_quiet(verb, o.common);
  add_json(verb, o.common);
}

}  // namespace slf::tools
