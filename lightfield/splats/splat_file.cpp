// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "lightfield/splats/splat_writers.h"
#include "lightfield/splats/turn_gaussians.h"
#include "slf/gaussian_files.h"

namespace slf {
namespace {

Result<Bytes, InputError> file_of(const SplatRows& rows, SplatFormat format) {
  switch (format) {
    case SplatFormat::kPly:
      return write_splat_ply(rows);
    case SplatFormat::kGlb:
      return write_splat_glb(rows);
    case SplatFormat::kSpz:
      return write_spz(rows, 2);
    case SplatFormat::kSpz3:
      return write_spz(rows, 3);
  }
  return InputError{Errc::kInvalidArgument, "no such format of splats"};
}

}  // namespace

SplatCloud as_stored(SplatCloud splats, SplatFormat format) {
  const bool spz = format == SplatFormat::kSpz || format == SplatFormat::kSpz3;
  return spz ? rounded_to_spz(std::move(splats)) : splats;
}

Result<std::vector<std::uint8_t>, InputError> splat_file(const SplatCloud& splats,
                                                         SplatFormat format) {
  return file_of(DiscRows(splats), format);
}

Result<std::vector<std::uint8_t>, InputError> gaussian_file(Gaussians gaussians,
                                                            SplatFormat format) {
  if (gaussians.size() == 0) return InputError{Errc::kInvalidInput, "has no splats"};
  const SplatAxes axes = format == SplatFormat::kPly ? SplatAxes::kYDown : SplatAxes::kYUp;
  const Gaussians turned = in_axes(std::move(gaussians), axes);
  return file_of(GaussianRows(turned), format);
}

Gaussians gaussians_of(const SplatCloud& splats, UpAxis up) {
  const DiscRows rows(splats);
  Gaussians out;
  out.degree = splats.degree;
  out.up = up;
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
