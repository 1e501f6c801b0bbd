// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "lightfield/splats/splat_writers.h"
#include "lightfield/splats/turn_gaussians.h"
#include "slf/gaussian_files.h"

namespace slf {
namespace {

Result<Bytes, InputError> file_of(const SplatRows& rows, SplatFormat format, int threads) {
  switch (format) {
    case SplatFormat::kPly:
      return write_splat_ply(rows);
    case SplatFormat::kGlb:
      return write_splat_glb(rows);
    case SplatFormat::kSpz:
      return write_spz(rows, 2);
    case SplatFormat::kSpz3:
      return write_spz(rows, 3);
    case SplatFormat::kSpz4:
      return write_spz(rows, 4);
    case SplatFormat::kSog:
      return write_sog(rows, threads);
  }
  return InputError{Errc::kInvalidArgument, "no such format of splats"};
}

}  // namespace

SplatAxes axes_of(SplatFormat format) {
  return format == SplatFormat::kPly || format == SplatFormat::kSog ? SplatAxes::kYDown
                                                                    : SplatAxes::kYUp;
}

SplatCloud as_stored(SplatCloud splats, SplatFormat format, int threads) {
  switch (format) {
    case SplatFormat::kPly:
    case SplatFormat::kGlb:
      return splats;
    case SplatFormat::kSpz:
    case SplatFormat::kSpz3:
    case SplatFormat::kSpz4:
      return rounded_to_spz(std::move(splats));
    case SplatFormat::kSog:
      return rounded_to_sog(std::move(splats), threads);
  }
  return splats;
}

Result<std::vector<std::uint8_t>, InputError> splat_file(const SplatCloud& splats,
                                                         SplatFormat format, int threads) {
  return file_of(DiscRows(splats), format, threads);
}

Result<std::vector<std::uint8_t>, InputError> gaussian_file(Gaussians gaussians, SplatFormat format,
                                                            int threads) {
  if (gaussians.size() == 0) return InputError{Errc::kInvalidInput, "has no splats"};
  SLF_CHECK(check_gaussians(gaussians));
  const Gaussians turned = in_axes(std::move(gaussians), axes_of(format));
  return file_of(GaussianRows(turned), format, threads);
}

Gaussians gaussians_of(const SplatCloud& splats, UpAxis up) {
  const DiscRows rows(splats);
  Gaussians out;
  out.degree = splats.degree;
  out.up = up;
  out.origin = rows.origin();
  out.positions = splats.positions;
  out.harmonics = splats.harmonics;
  for (std::size_t p = 0; p < splats.size(); ++p) {
    out.log_deviations.push_back(rows.log_deviations(p));
    out.rotations.push_back(rows.rotation(p));
    out.logits.push_back(rows.logit(p));
  }
  return out;
}

}  // namespace slf
