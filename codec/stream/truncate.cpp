// SPDX-License-Identifier: Apache-2.0
// A stream with less in it: units are kept or left out, none is coded again. Spec 7.2, 8.9.
#include <algorithm>
#include <array>

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

/// The stream that is cut, and what is written of it.
struct Cut {
  const StreamHeader& before;
  bool ended;  ///< it had an end unit
  SequenceParameterSet set;
  std::optional<std::vector<CellBox>> boxes;  ///< of an index

  /// What a stream need not have is left out where it would make the cut one longer than it was: an
  /// index, as where units stood before it that it did not list, and the end unit of one that had
  /// none. An index with more entries than there were units and entries is left out, too.
  Result<std::vector<std::uint8_t>> with(std::span<const UnitView> units) const {
    std::vector<std::uint8_t> stream;
    if (boxes && 2 * units.size() <= before.units) {
      SLF_TRY(stream, of_what_was_read(assemble(set, units, boxes)));
      if (stream.size() <= before.bytes) return stream;
    }
    SLF_TRY(stream, of_what_was_read(assemble(set, units, std::nullopt)));
    if (stream.size() > before.bytes && !ended)
      stream.resize(stream.size() - static_cast<std::size_t>(unit_bytes(
                                        UnitType::kEnd, end_payload(units.size() + 1).size())));
    return stream;
  }
};

/// As many of the units as fit, the first first.
Result<std::vector<std::uint8_t>> assemble_within(const Cut& cut, std::span<const UnitView> units,
                                                  std::uint64_t max_bytes) {
  SLF_TRY(auto whole, cut.with(units));
  if (max_bytes == 0 || whole.size() <= max_bytes) return whole;
  std::size_t fits = 0, too_many = units.size();
  while (fits + 1 < too_many) {
    const std::size_t middle = fits + (too_many - fits) / 2;
    SLF_TRY(const auto some, cut.with(units.first(middle)));
    (some.size() <= max_bytes ? fits : too_many) = middle;
  }
  SLF_TRY(auto some, cut.with(units.first(fits)));
  if (some.size() > max_bytes) return Error{Errc::kInvalidArgument, "max_bytes"};
  return some;
}

/// A decode of the cut stream is held to its bytes, which are fewer. A stream that was partial
/// before is not checked: its headers say more than it has.
/// @errors kLimitExceeded: max_values_per_byte
Result<Done> check_values_of_cut(const Request& asked, const std::vector<std::uint8_t>& chosen,
                                 std::uint64_t bytes, const DecodeLimits& limits) {
  if (!asked.stream.complete) return Done{};
  Request request = asked;
  request.most_values = most_values(limits, bytes);
  std::uint64_t rows = request.stream.num_cells();
  for (std::size_t s = 0; s < chosen.size() && !request.base_alone(); ++s)
    if (chosen[s]) rows += request.stream.table.slices[s].points();
  return check_values(request, rows);
}

/// Copies an empty frame whose frame unit is missing: there is nothing to leave out, and no end
/// unit to write behind it (7.13).
Result<std::vector<std::uint8_t>> copy_of(std::span<const std::uint8_t> stream,
                                          std::uint64_t max_bytes) {
  if (max_bytes > 0 && stream.size() > max_bytes) return Error{Errc::kInvalidArgument, "max_bytes"};
  return std::vector<std::uint8_t>(stream.begin(), stream.end());
}

/// A stream that nothing is left out of: no longer than it was, and its digests stay. The sequence
/// unit of a later version becomes one of this (7.1.2).
Result<std::vector<std::uint8_t>> as_it_was(std::span<const std::uint8_t> stream,
                                            const Units& units, const SequenceParameterSet& set) {
  std::vector<std::uint8_t> copy(kSignature.begin(), kSignature.end());
  SLF_CHECK(of_what_was_read(append_sequence(copy, set)));
  const Unit& sequence = units.units.front();
  const auto rest = stream.subspan(static_cast<std::size_t>(sequence.offset + sequence.bytes));
  copy.insert(copy.end(), rest.begin(), rest.end());
  return copy;
}

/// Was as much left out of one before as is out of the other?
bool is_cut_alike(const SequenceParameterSet& before, const SequenceParameterSet& cut) {
  const auto left = [](const SequenceParameterSet& s) {
    return std::array{s.sps_cut_flag, s.sps_cut_levels, s.sps_cut_groups, s.sps_cut_layers,
                      s.sps_cut_slices_flag};
  };
  return left(before) == left(cut);
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
  SLF_TRY(const SelectedUnits kept, select_units(units, request, chosen));
  std::vector<std::uint8_t> present;
  for (const PartUnits& slice : scene.slices) present.push_back(!slice.empty());
  Cut cut{scene.stream, units.complete, cut_sequence(request, chosen, present), {}};
  const bool is_all = kept.all && (request.whole || is_cut_alike(scene.stream.set, cut.set));
  const bool fits = options.max_bytes == 0 || stream.size() <= options.max_bytes;
  if (is_all && fits) return as_it_was(stream, units, scene.stream.set);
  SLF_TRY(auto index, find_index(units, scene.stream.set));
  if (index) cut.boxes = std::move(index->boxes);
  index.reset();  // its entries
  SLF_TRY(auto less, assemble_within(cut, kept.units, options.max_bytes));
  // To say that it is cut can take more bytes than were left out.
  if (less.size() > stream.size()) return as_it_was(stream, units, scene.stream.set);
  SLF_CHECK(check_values_of_cut(request, chosen, less.size(), options.limits));
  return less;
}

}  // namespace slf
