// SPDX-License-Identifier: Apache-2.0
// PSNR of every view of a plenoptic cloud, as its codecs are judged.
#include <cmath>

#include "base/error_sum.h"
#include "encoder/plenoptic/plenoptic_coding.h"
#include "slf/plenoptic.h"

namespace slf {
namespace {

/// ITU-R BT.709, full range: differences of Y, U, V are those of differences of R, G, B.
std::array<double, 3> yuv_of(const std::array<double, 3>& rgb) {
  const double y = luma(rgb);
  return {y, (rgb[2] - y) / 1.8556, (rgb[0] - y) / 1.5748};
}

double psnr_of(double squares, std::size_t count) {
  return 10 * std::log10(255.0 * 255.0 * static_cast<double>(count) / squares);
}

}  // namespace

Result<PlenopticQuality, InputError> measure_plenoptic(const PlenopticCloud& decoded,
                                                       const PlenopticCloud& original) {
  SLF_CHECK(check_plenoptic_cloud(decoded));
  SLF_CHECK(check_plenoptic_cloud(original));
  if (decoded.positions != original.positions)
    return InputError{Errc::kInvalidInput, "the file has other points than the cloud: " +
                                               std::to_string(decoded.num_points()) + " and " +
                                               std::to_string(original.num_points())};
  if (decoded.views != original.views || decoded.own_colour != original.own_colour)
    return InputError{Errc::kInvalidInput, "the file has " + std::to_string(decoded.views) +
                                               " views, the cloud " +
                                               std::to_string(original.views)};
  const std::size_t row = 3 * original.num_colours(), own = original.own_colour ? 3 : 0;
  std::vector<std::array<double, 3>> squares(original.views);
  for (std::size_t at = own; at < original.colours.size(); at += row)
    for (std::size_t v = 0; v < original.views; ++v) {
      std::array<double, 3> error{};
      for (std::size_t c = 0; c < 3; ++c)
        error[c] = decoded.colours[at + 3 * v + c] - original.colours[at + 3 * v + c];
      const std::array<double, 3> yuv = yuv_of(error);
      for (std::size_t c = 0; c < 3; ++c) squares[v][c] += yuv[c] * yuv[c];
    }
  PlenopticQuality quality;
  quality.points = original.num_points();
  for (const auto& of_view : squares) {
    ViewQuality& view = quality.views.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) view.yuv[c] = psnr_of(of_view[c], quality.points);
  }
  return quality;
}

}  // namespace slf
