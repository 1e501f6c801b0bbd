// SPDX-License-Identifier: Apache-2.0
#include "attributes/texture/encoder/texture_encoder.h"

#include <algorithm>

#include "attributes/texture/encoder/padding.h"
#include "attributes/texture/texture_header.h"
#include "attributes/video/encoder/hevc_encoder.h"
#include "bitstream/checked_syntax.h"

namespace slf {
namespace {

HevcSettings hevc_settings(const TextureSettings& settings) {
  const auto mode =
      settings.mode == TextureSettings::kIntra ? HevcMode::kIntra : HevcMode::kLowDelay;
  return {settings.qp, mode, settings.preset, settings.lossless};
}

/// Samples of a plane in their pixels, the others filled.
Picture picture_of(std::span<const std::int32_t> values, std::int32_t offset, std::uint32_t step,
                   int bits, const Atlas& atlas, std::span<const std::uint8_t> occupied) {
  Picture picture = blank_picture(atlas.width, atlas.height, bits, ChromaFormat::k400);
  const std::int64_t most = (std::int64_t{1} << bits) - 1;
  for (std::size_t p = 0; p < values.size(); ++p) {
    const std::int64_t nearest = (std::int64_t{values[p]} - offset + step / 2) / step;
    picture.planes[0][atlas.pixel[p]] = static_cast<std::uint16_t>(std::min(nearest, most));
  }
  pad_picture(picture.planes[0], occupied, atlas.width, atlas.height);
  return picture;
}

}  // namespace

Result<std::vector<std::uint8_t>, InputError> encode_texture(
    const Atlas& atlas, std::span<const std::uint32_t> steps, const TextureSettings& settings,
    const std::function<void(std::size_t plane, std::span<std::int32_t> values)>& source) {
  const std::int64_t most = (std::int64_t{1} << settings.bits) - 1;
  std::vector<std::int32_t> values(atlas.pixel.size());
  std::vector<TexturePlane> planes(steps.size());
  std::vector<std::size_t> pictures;  // planes that have one
  for (std::size_t j = 0; j < steps.size(); ++j) {
    source(j, values);
    const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
    planes[j] = {*least != *greatest, *least};
    if (*least <= -kTextureLimit || *greatest >= kTextureLimit ||
        (*least != *greatest && *least + most * steps[j] >= kTextureLimit))
      return InputError{Errc::kInvalidArgument,
                        "components: least, plus step times the largest sample, reaches 2^30"};
    if (planes[j].tx_picture_flag) pictures.push_back(j);
  }
  SLF_TRY(auto payload, checked_header([&](auto& v) { texture_header(v, std::as_const(planes)); }));
  if (pictures.empty()) return payload;

  std::vector<std::uint8_t> occupied(static_cast<std::size_t>(atlas.width) *
                                     static_cast<std::size_t>(atlas.height));
  for (const std::uint32_t pixel : atlas.pixel) occupied[pixel] = 1;
  const auto picture = [&](std::size_t i) {
    const std::size_t j = pictures[i];
    source(j, values);
    return picture_of(values, planes[j].tx_offset, steps[j], settings.bits, atlas, occupied);
  };
  SLF_TRY(const auto stream, encode_hevc(pictures.size(), picture, hevc_settings(settings)));
  payload.insert(payload.end(), stream.begin(), stream.end());
  return payload;
}

}  // namespace slf
