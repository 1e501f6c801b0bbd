// SPDX-License-Identifier: Apache-2.0
#include "attributes/texture/texture_decoder.h"

#include <vector>

#include "attributes/texture/texture_header.h"
#include "attributes/video/hevc_decoder.h"
#include "base/error_place.h"

namespace slf {

Result<Done> decode_texture(
    std::span<const std::uint8_t> payload, const Atlas& atlas, int bits,
    std::span<const std::uint32_t> steps,
    const std::function<void(std::size_t plane, std::span<const std::int32_t> values)>& sink) {
  BitReader in(payload);
  ParseSyntax parse{in};
  std::vector<TexturePlane> planes(steps.size());
  texture_header(parse, planes);
  const auto stream = in.align_and_rest("alignment_zero_bits");
  if (!in.ok()) return in.error();

  const std::uint64_t begin = 8 * (payload.size() - stream.size());
  const std::int64_t most = (std::int64_t{1} << bits) - 1;
  std::vector<std::size_t> pictures;  // planes that have one
  std::vector<std::int32_t> values(atlas.pixel.size());
  for (std::size_t j = 0; j < planes.size(); ++j) {
    if (planes[j].tx_picture_flag) {
      if (planes[j].tx_offset + most * steps[j] >= kTextureLimit)
        return Error{Errc::kOutOfRange, "tx_offset"};
      pictures.push_back(j);
    } else {
      values.assign(values.size(), planes[j].tx_offset);
      sink(j, values);
    }
  }
  if (pictures.empty()) {
    if (!stream.empty()) return Error{Errc::kOutOfRange, "tx_pictures", begin};
    return Done{};
  }
  const HevcFormat format{atlas.width, atlas.height, bits, ChromaFormat::k400, pictures.size()};
  const auto store = [&](std::size_t i, const Picture& picture) {
    const std::size_t j = pictures[i];
    const auto step = static_cast<std::int32_t>(steps[j]);
    for (std::size_t p = 0; p < values.size(); ++p)
      values[p] = planes[j].tx_offset + picture.planes[0][atlas.pixel[p]] * step;
    sink(j, values);
  };
  return counted_from(begin, decode_hevc(stream, format, store));
}

}  // namespace slf
