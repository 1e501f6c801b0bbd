// SPDX-License-Identifier: Apache-2.0
// What `slf html` makes of a file: its first view as a picture, and a page in which nothing that
// the file says ends the element that it stands in.
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "slf/gaussian_renderer.h"
#include "slf/jpeg.h"
#include "slf/render.h"
#include "tests/fuzz/fuzz.h"
#include "tools/html_page.h"

namespace {

constexpr int kPixels = 24;
constexpr std::string_view kPage =
    "<title>{{slf:title}}</title>{{slf:night}}<img src=\"{{slf:poster}}\">"
    "<script>{{slf:options}}</script><script>{{slf:file}}</script>";

void require(bool holds) {
  if (!holds) std::abort();
}

template <class Drawn, class Of>
slf::Image first_view(const Of& of, const std::optional<slf::Camera>& camera) {
  slf::RenderSettings settings;
  settings.threads = 1;
  const Drawn renderer(of, settings);
  return renderer.render(camera ? *camera : renderer.orbit(0.1, 20, kPixels, kPixels)).image;
}

std::string poster_of(const slf::LightField& field, const std::optional<slf::Camera>& camera) {
  slf::Image image;
  if (has_gaussians(field.header)) {
    const auto splats = slf::gaussians_of(field, 1);
    if (!splats) return "";
    image = first_view<slf::GaussianRenderer>(*splats, camera);
  } else {
    image = first_view<slf::Renderer>(slf::ViewMaps(field, 1), camera);
  }
  const auto jpeg = slf::encode_jpeg(image, 75);
  require(static_cast<bool>(jpeg));
  return "data:image/jpeg;base64," + std::to_string(jpeg->size());
}

/// Between two texts that stand there once.
std::string between(const std::string& page, const std::string& open, const std::string& close) {
  const std::size_t begin = page.find(open);
  require(begin != page.npos);
  const std::size_t end = page.find(close, begin + open.size());
  require(end != page.npos);
  return page.substr(begin + open.size(), end - begin - open.size());
}

void check_page(const std::string& page, const std::string& title) {
  const std::string shown = between(page, "<title>", "</title>");
  require(shown.find_first_of("<>\"'") == shown.npos);
  const std::string options = between(page, "<script>", "</script>");
  require(options.find('<') == options.npos);
  const auto parsed = nlohmann::json::parse(options, nullptr, false);
  require(!parsed.is_discarded() && parsed["title"].is_string() && title.size() <= 260);
  const std::size_t file = page.rfind("<script>") + 8;
  require(page.find_first_not_of(
              "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/=", file) ==
          page.size() - std::string("</script>").size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto stream = slf::fuzz::with_sound_crcs({data, size});
  slf::DecodeOptions options;
  options.limits = slf::fuzz::small_limits();
  options.limits.max_points = 1 << 10;
  const auto info = slf::read_info(stream, options.limits);
  const auto field = slf::decode(stream, options);
  if (!info || !field || !field->header.has_basis || field->header.num_functions == 0 ||
      !field->header.grid.fits_floats())
    return 0;
  const auto camera = slf::named_view(info->metadata, field->header.up, kPixels, kPixels);
  const std::string title = slf::tools::page_title(info->metadata);
  nlohmann::ordered_json said{{"title", title}};
  if (camera) said["view"] = slf::tools::view_json(*camera);
  check_page(slf::tools::html_page(kPage, title, {poster_of(*field, camera), ""}, said, stream),
             title);
  slf::fuzz::accept(true);
  return 0;
}
