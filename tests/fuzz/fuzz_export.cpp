// SPDX-License-Identifier: Apache-2.0
// A light field that decodes is written as splats of every format, or refused: no number of a file
// is NaN or infinite, and what other readers of ours read of it has as many splats. The first byte
// is the format, the second says degree and axes.
#include <cmath>
#include <cstdlib>

#include "slf/gaussian_files.h"
#include "slf/gaussians.h"
#include "slf/splats.h"
#include "slf/view_map.h"
#include "tests/fuzz/fuzz.h"

namespace {

using slf::SplatFormat;

void require(bool holds) {
  if (!holds) std::abort();
}

bool all_finite(std::span<const float> values) {
  for (const float v : values)
    if (!std::isfinite(v)) return false;
  return true;
}

bool all_finite(const std::vector<std::array<float, 3>>& values) {
  for (const auto& v : values)
    if (!all_finite(v)) return false;
  return true;
}

/// A file of ours is one that we read.
void check_file(const std::vector<std::uint8_t>& file, std::size_t splats) {
  const auto read = slf::parse_gaussians("fuzz", file);
  require(read && read->gaussians.size() + read->left_out == splats);
  require(all_finite(read->gaussians.positions) && all_finite(read->gaussians.harmonics));
  slf::fuzz::accept(true);
}

void export_gaussians(const slf::LightField& field, SplatFormat format) {
  auto gaussians = slf::gaussians_of(field, 1);
  if (!gaussians) return;
  const std::size_t count = gaussians->size();
  const auto file = slf::gaussian_file(*std::move(gaussians), format, 1);
  if (file) check_file(*file, count);
}

void export_surface(const slf::LightField& field, SplatFormat format, std::uint8_t how) {
  const slf::ViewMaps maps(field, 1);
  slf::SplatSettings settings;
  settings.degree = how % 4;
  settings.axes = static_cast<slf::SplatAxes>(how / 4 % 3);
  settings.threads = 1;
  const auto splats = slf::make_splats(maps, settings);
  if (!splats) return;
  require(splats->size() == field.num_points());
  require(all_finite(splats->positions) && all_finite(splats->normals) &&
          all_finite(splats->deviations) && all_finite(splats->harmonics));
  const auto file = slf::splat_file(*splats, format, 1);
  if (!file) return;
  check_file(*file, splats->size());
  require(!std::isnan(slf::splat_loss(maps, slf::as_stored(*splats, format, 1), 1).psnr));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const auto format = static_cast<SplatFormat>(data[0] % 6);
  slf::DecodeOptions options;
  options.limits = slf::fuzz::small_limits();
  options.limits.max_points = 1 << 9;
  const auto field = slf::decode(slf::fuzz::with_sound_crcs({data + 2, size - 2}), options);
  if (!field || !field->header.has_basis || field->header.num_functions == 0) return 0;
  if (!field->header.grid.fits_floats()) return 0;  // as the program refuses them
  if (has_gaussians(field->header)) {
    export_gaussians(*field, format);
  } else {
    export_surface(*field, format, data[1]);
  }
  return 0;
}
