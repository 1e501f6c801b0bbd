// SPDX-License-Identifier: Apache-2.0
// Coefficient units of a slice whose planes are pictures. Mirror of slice_texture_decoder.cpp.
#include <optional>

#include "attributes/texture/atlas.h"
#include "attributes/texture/encoder/texture_encoder.h"
#include "attributes/texture/texture_decoder.h"
#include "codec/encoder/slice_encoder.h"
#include "slf/parallel.h"

namespace slf {
namespace {

using Payload = std::vector<std::uint8_t>;

Result<Payload, InputError> encode_group(std::size_t group, const SliceInput& input,
                                         const Atlas& atlas, const SliceCoding& coding) {
  const std::size_t row = coding.steps.size();
  const std::vector<std::size_t> planes = planes_of(coding.groups[group]);
  std::vector<std::uint32_t> steps;
  for (const std::size_t j : planes) steps.push_back(coding.steps[j]);
  SLF_TRY(Payload payload, encode_texture(atlas, steps, coding.texture,
                                          [&](std::size_t i, std::span<std::int32_t> values) {
                                            for (std::size_t p = 0; p < values.size(); ++p)
                                              values[p] = input.components[p * row + planes[i]];
                                          }));
  if (!coding.digest) return payload;
  const auto decoded = decode_texture(payload, atlas, coding.texture.bits, steps,
                                      [&](std::size_t i, std::span<const std::int32_t> values) {
                                        for (std::size_t p = 0; p < values.size(); ++p)
                                          input.components[p * row + planes[i]] = values[p];
                                      });
  if (decoded) return payload;
  return InputError{Errc::kUnsupported,
                    decoded.error().code == Errc::kUnsupported
                        ? "digest of a texture: libde265 is not part of this build (SLF_HEVC)"
                        : "digest of a texture: libde265 does not decode what x265 coded"};
}

}  // namespace

Result<CodedUnits, InputError> encode_slice_texture(const SliceToEncode& slice, int threads) {
  const SliceCoding& coding = slice.coding;
  const auto atlas = derive_atlas(slice.input.morton, coding.grid_bits(),
                                  static_cast<int>(coding.set.sps_texture_cell_log2));
  if (!atlas)
    return InputError{Errc::kInvalidArgument,
                      "points per slice: a texture would be higher than 8192; fewer are needed"};
  std::vector<std::optional<Result<Payload, InputError>>> coded(coding.groups.size());
  parallel_ranges(coded.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g)
      coded[g] = encode_group(g, slice.input, *atlas, coding);
  });
  CodedUnits units;
  for (const UnitSlot& slot : slice.slots) {
    if (!has_values(slot.type)) continue;
    SLF_TRY(Payload payload, std::move(*coded[slot.group]));
    SLF_TRY(CodedUnit unit,
            coefficient_unit(ids_of(slot, slice.slice_id()), std::move(payload), coding));
    units.push_back(std::move(unit));
  }
  return units;
}

}  // namespace slf
