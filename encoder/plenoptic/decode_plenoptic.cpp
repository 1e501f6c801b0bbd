// SPDX-License-Identifier: Apache-2.0
// From a decoded field to the cloud that it was made from.
#include <algorithm>

#include "base/error_words.h"
#include "encoder/plenoptic/corrections.h"
#include "encoder/plenoptic/plenoptic_planes.h"
#include "encoder/plenoptic/plenoptic_view_maps.h"

namespace slf {
namespace {

/// Corrects the bytes of an exact file that is whole.
Result<Done, InputError> correct(std::span<const std::uint8_t> stream, const LightField& field,
                                 int threads, std::vector<std::uint8_t>& bytes,
                                 std::vector<std::string>* warnings) {
  if (field.num_points() == 0) return Done{};
  Result<std::span<const std::uint8_t>> payload = std::span<const std::uint8_t>{};
  if (!field.partial) payload = find_corrections(stream);
  if (!payload) return InputError{payload.error().code, in_words(payload.error())};
  if (!corrects(*payload, field.num_points())) {
    if (warnings != nullptr)
      warnings->emplace_back(
          "the file is not whole: its bytes are near the exact ones, within a step");
    return Done{};
  }
  const std::size_t row = 3 * static_cast<std::size_t>(field.header.num_functions);
  const auto applied = apply_corrections(*payload, row, bytes, threads);
  if (!applied) return InputError{Errc::kInvalidInput, in_words(applied.error())};
  return Done{};
}

}  // namespace

Result<PlenopticCloud, InputError> decode_plenoptic(std::span<const std::uint8_t> stream,
                                                    const LightField& field,
                                                    const Metadata& metadata,
                                                    std::vector<std::string>* warnings,
                                                    int threads) {
  SLF_TRY(const PlenopticRecord record, read_record(metadata));
  PlenopticCloud cloud;
  cloud.grid = field.header.grid;
  cloud.positions = field.positions;
  cloud.views = record.views;
  cloud.own_colour = record.own_colour;
  cloud.view_positions = record.view_positions;
  cloud.properties = record.properties;
  if (record.as == PlenopticCoding::kViewMaps) {
    if (!field.header.has_basis)
      return InputError{Errc::kInvalidInput, "metadata plenoptic: the file has no view maps"};
    look_from_views(field, record, threads, cloud);
    return cloud;
  }
  const std::size_t coded = cloud.num_colours() - (record.mean ? 1 : 0);
  if (field.header.has_basis || static_cast<std::size_t>(field.header.num_functions) != coded ||
      field.header.shift.size() != coded)
    return InputError{Errc::kInvalidInput,
                      "metadata plenoptic_properties: not those of the file's planes"};
  std::vector<std::uint8_t> bytes = bytes_of_planes(field, threads);
  if (record.exact) SLF_CHECK(correct(stream, field, threads, bytes, warnings));
  set_colours(std::move(bytes), record, cloud);
  return cloud;
}

}  // namespace slf
