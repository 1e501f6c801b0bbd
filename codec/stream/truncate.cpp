// SPDX-License-Identifier: Apache-2.0
// A stream with less in it: units are kept or left out, none is coded again. Spec 7.2, 8.9.
#include <algorithm>

#include "codec/decoder/base_decoder.h"
#include "codec/decoder/decode_cost.h"
#include "codec/encoder/assemble.h"
#include "codec/scene_units.h"
#include "codec/stream/select_units.h"
#include "slf/frames.h"
#include "slf/truncate.h"

namespace slf {
namespace {

/// Only headers and the geometry of the base are decoded, and that only where a region asks for it.
Result<std::vector<std::uint8_t>> choose_by_region(const SceneUnits& scene, const Request& request,
                                                   const DecodeOptions& options) {
  std::vector<std::uint8_t> chosen(scene.slices.size(), true);
  if (!request.region || !scene.stream.has_base() || scene.slices.empty()) return chosen;
  SLF_TRY(const BaseState base, decode_base_geometry(scene.base, request));
  if (!base.is_known(scene.stream)) return chosen;
  chosen = choose_slices_by_cell(request, base);
  if (!request.base_alone()) SLF_CHECK(check_limits_of_slices(request, options, chosen));
  return chosen;
}

/// As many of the units as fit, the first first.
Result<std::vector<std::uint8_t>> assemble_within(const SequenceParameterSet& set,
                                                  std::span<const CodedUnit> units,
                                                  const std::optional<std::vector<CellBox>>& boxes,
                                                  std::uint64_t max_bytes) {
  SLF_TRY(auto whole, of_what_was_read(assemble(set, units, boxes)));
  if (max_bytes == 0 || whole.size() <= max_bytes) return whole;
  std::size_t fits = 0, too_many = units.size();
  while (fits + 1 < too_many) {
    const std::size_t middle = fits + (too_many - fits) / 2;
    SLF_TRY(const auto some, of_what_was_read(assemble(set, units.first(middle), boxes)));
    (some.size() <= max_bytes ? fits : too_many) = middle;
  }
  SLF_TRY(auto some, of_what_was_read(assemble(set, units.first(fits), boxes)));
  if (some.size() > max_bytes) return Error{Errc::kInvalidArgument, "max_bytes"};
  return some;
}

/// Copies an empty frame whose frame unit is missing: there is nothing to leave out, and no end
/// unit to write behind it (7.13).
Result<std::vector<std::uint8_t>> copy_of(std::span<const std::uint8_t> stream,
                                          std::uint64_t max_bytes) {
  if (max_bytes > 0 && stream.size() > max_bytes) return Error{Errc::kInvalidArgument, "max_bytes"};
  return std::vector<std::uint8_t>(stream.begin(), stream.end());
}

}  // namespace

Result<std::vector<std::uint8_t>> truncate(std::span<const std::uint8_t> stream,
                                           const DecodeOptions& options) {
  SLF_TRY(const OpenStream opened, open_stream(stream, options.limits));
  const auto& [units, scene] = opened;
  if (units.first(UnitType::kFrame) != nullptr)
    return truncate_frames(stream, 0, SIZE_MAX, options);
  if (scene.stream.set.is_empty_frame()) return copy_of(stream, options.max_bytes);
  SLF_CHECK(collect_metadata(units));
  SLF_TRY(const Request request, request_of(units, scene, options));
  SLF_CHECK(check_limits(request, options));
  SLF_TRY(const auto chosen, choose_by_region(scene, request, options));
  SLF_TRY(const std::vector<CodedUnit> kept, select_units(units, request, chosen));
  SLF_TRY(const auto index, find_index(units, scene.stream.set));
  std::optional<std::vector<CellBox>> boxes;
  if (index) boxes = index->boxes;
  std::vector<std::uint8_t> present;
  for (const PartUnits& slice : scene.slices) present.push_back(!slice.empty());
  return assemble_within(cut_sequence(request, chosen, present), kept, boxes, options.max_bytes);
}

}  // namespace slf
