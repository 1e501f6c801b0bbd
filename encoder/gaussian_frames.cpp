// SPDX-License-Identifier: Apache-2.0
#include "encoder/gaussian_frames.h"

#include <algorithm>
#include <string>
#include <utility>

#include "base/input_error.h"
#include "encoder/gaussian_planes.h"
#include "slf/encode_gaussians.h"

namespace slf {

Result<Done, InputError> GaussianExtent::add(const Gaussians& shown) {
  if (shown.size() == 0) return Done{};
  if (!first_) {
    const double deviation = typical_deviation(shown);
    first_ = First{shown.degree, shown.up, {deviation, room_of(shown, deviation)}};
  }
  if (shown.degree != first_->degree)
    return invalid_input("splats have harmonics of degree " + std::to_string(shown.degree) +
                         ", and those of the frames before of degree " +
                         std::to_string(first_->degree));
  if (shown.up != first_->up) return invalid_input("another axis is up than in the frames before");
  widen(bounds_of(shown), shown.size());
  return Done{};
}

void GaussianExtent::widen(const std::array<Vec3, 2>& box, std::size_t splats) {
  if (!has_box_) box_ = box;
  has_box_ = true;
  for (std::size_t k = 0; k < 3; ++k) {
    box_[0][k] = std::min(box_[0][k], box[0][k]);
    box_[1][k] = std::max(box_[1][k], box[1][k]);
  }
  most_ = std::max(most_, splats);
}

Result<Grid, InputError> GaussianExtent::grid(double q, const EncoderSettings& settings) const {
  SplatSizes sizes = first_->sizes;
  for (std::size_t k = 0; k < 3; ++k)
    sizes.extent = std::max(sizes.extent, box_[1][k] - box_[0][k]);
  return grid_around(box_, grid_step_of(q, sizes, settings), most_);
}

LightFieldHeader GaussianExtent::header(const Grid& grid) const {
  return header_of_splats(grid, first_->degree, first_->up);
}

Result<GaussianFrameEncoder, InputError> GaussianFrameEncoder::open(const GaussianExtent& extent,
                                                                    const EncoderSettings& settings,
                                                                    int group, std::uint32_t first,
                                                                    const Vec3& origin) {
  const double q = settings.q == kAutomaticQ ? kGaussianQ : settings.q;
  SLF_TRY(const Grid local, extent.grid(q, settings));
  LightFieldHeader header = extent.header(local);
  for (std::size_t k = 0; k < 3; ++k) header.grid.origin[k] += origin[k];
  SLF_CHECK(check_drawn(header.grid));
  header.metres_per_unit = settings.metres_per_unit;
  return GaussianFrameEncoder(std::move(header), local, q, settings, group, first);
}

GaussianFrameEncoder::GaussianFrameEncoder(LightFieldHeader header, const Grid& local, double q,
                                           const EncoderSettings& settings, int group,
                                           std::uint32_t first)
    : header_(std::move(header)),
      local_(local),
      q_(q),
      threads_(settings.threads),
      encoder_(
          [&] {
            CodingParameters parameters =
                gaussian_parameters(header_, steps_of(q), level_ends(header_.grid.bits), settings);
            parameters.metadata = metadata_of_gaussians(q, settings);
            return parameters;
          }(),
          group, first) {}

Result<std::vector<std::uint8_t>, InputError> GaussianFrameEncoder::add(const Gaussians& shown,
                                                                        double time) {
  LightField field;
  if (shown.size() > 0) {
    SLF_TRY(field, light_field_on(shown, local_, threads_));
    if (field.header.basis.degree != header_.basis.degree || field.header.up != header_.up)
      return invalid_input("splats: another degree or up axis than in the frames before");
  }
  field.header = header_;
  return encoder_.add(field, time);
}

}  // namespace slf
