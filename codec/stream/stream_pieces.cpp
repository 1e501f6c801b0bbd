// SPDX-License-Identifier: Apache-2.0
#include "codec/stream/stream_pieces.h"

#include <algorithm>

#include "base/error_place.h"
#include "codec/decoder/decode_cost.h"
#include "codec/decoder/decode_units.h"
#include "codec/decoder/request.h"
#include "codec/split_frames.h"

namespace slf {
namespace {

/// The whole units among the first bytes of a stream, of its first frame.
Result<Units> units_of_beginning(std::span<const std::uint8_t> begin, std::uint64_t max_memory) {
  SLF_TRY(const FrameUnits first, first_frame(begin));  // 7.13
  const auto frame = begin.first(static_cast<std::size_t>(first.bytes));
  return split_units(frame, std::max<std::size_t>(frame.size(), 1) - 1, max_memory);
}

/// The stream ends inside a unit that the index lists.
Error cut_short(const IndexEntry& entry, std::uint64_t offset) {
  return of_unit(entry.type, offset, Errc::kTruncated, "unit_payload");
}

/// The unit that the index lists, in the piece where it lies.
/// @param disagrees  the error where it is another
Result<Unit> take_unit(const ReadPlan::Wanted& wanted, std::span<const StreamPiece> pieces,
                       const SequenceParameterSet& set, const Error& disagrees) {
  const auto after = std::upper_bound(
      pieces.begin(), pieces.end(), wanted.offset,
      [](std::uint64_t offset, const StreamPiece& piece) { return offset < piece.offset; });
  if (after == pieces.begin()) return disagrees;
  const StreamPiece& piece = *std::prev(after);
  const std::uint64_t at = wanted.offset - piece.offset;
  if (at >= piece.bytes.size()) return cut_short(wanted.entry, wanted.offset);
  SLF_TRY(Unit unit,
          counted_from(8 * piece.offset, read_unit(piece.bytes, static_cast<std::size_t>(at))));
  unit.offset += piece.offset;
  unit.payload_offset += piece.offset;
  if (unit.type != wanted.entry.type || unit.bytes != wanted.entry.bytes) return disagrees;
  SLF_TRY(const SliceUnitHeader ids, read_ids(unit, set));
  if (!same_ids(ids, wanted.entry.ids)) return disagrees;
  return unit;
}

/// Chooses, among the units behind the head, those wanted. A stream may have been cut between two.
/// @param begin  of the first unit of the index
Result<Done> choose_units(const Index& index, std::uint64_t begin, const ByteRange& behind,
                          const Request& request, const std::vector<std::uint8_t>& chosen,
                          std::uint64_t max_bytes, ReadPlan& plan) {
  for (const IndexEntry& entry : index.entries) {
    const ByteRange range{begin, entry.bytes};
    SLF_CHECK(check_understood(entry.type, range.offset));
    begin = range.end();
    if (range.offset >= behind.end() || (max_bytes > 0 && range.end() > max_bytes)) break;
    if (range.end() > behind.end()) return cut_short(entry, range.offset);
    if (range.offset < behind.offset || !has_ids(entry.type) ||
        !wants_unit(request, chosen, entry.type, entry.ids))
      continue;
    plan.units.push_back({range.offset, entry});
    if (!plan.ranges.empty() && plan.ranges.back().end() == range.offset) {
      plan.ranges.back().bytes += range.bytes;
    } else {
      plan.ranges.push_back(range);
    }
  }
  return Done{};
}

/// Is nothing left out, digests included?
bool wants_all(const Request& request, const DecodeOptions& options) {
  return request.whole && !request.region && options.max_bytes == 0;
}

}  // namespace

std::uint64_t ReadPlan::bytes() const {
  std::uint64_t sum = 0;
  for (const ByteRange& range : ranges) sum += range.bytes;
  return sum;
}

Result<std::optional<StreamHead>> find_head(std::span<const std::uint8_t> begin,
                                            std::uint64_t stream_bytes, std::uint64_t max_memory) {
  SLF_TRY(const Units units, units_of_beginning(begin, max_memory));
  if (units.units.empty()) return std::optional<StreamHead>();
  SLF_TRY(const SequenceParameterSet set, find_sequence(units));
  for (const Unit& unit : units.units) {
    if (has_ids(unit.type)) return std::optional(StreamHead{stream_bytes, false});
    if (unit.type != UnitType::kIndex) continue;
    SLF_TRY(const Index index, read_index(unit, set));
    std::uint64_t end = unit.offset + unit.bytes, head = 0;
    for (const IndexEntry& entry : index.entries) {
      if (head == 0 && has_ids(entry.type)) head = end;
      end += entry.bytes;
    }
    if (head == 0) head = end;
    const bool ends = !index.entries.empty() && index.entries.back().type == UnitType::kEnd;
    return std::optional(StreamHead{std::min(head, stream_bytes), ends && end == stream_bytes});
  }
  return std::optional<StreamHead>();
}

Result<ReadPlan> plan_read(std::span<const std::uint8_t> head, std::uint64_t stream_bytes,
                           const DecodeOptions& options) {
  const bool is_all = head.size() == stream_bytes;
  std::span<const std::uint8_t> frame = head;
  if (is_all) {
    SLF_TRY(const FrameUnits first, first_frame(head));  // 7.13
    frame = head.first(static_cast<std::size_t>(first.bytes));
  }
  SLF_TRY(const Units units,
          split_units(frame, is_all ? options.max_bytes : 0, options.limits.max_memory));
  ReadPlan plan;
  SLF_TRY(plan.set, find_sequence(units));
  SLF_TRY(const SceneUnits scene, collect_units(units, plan.set));
  SLF_TRY(const Request request, request_of(units, scene, options));
  SLF_TRY(plan.cost, check_limits(request, options));
  plan.components = request.coded.size();
  plan.points =
      request.base_alone() ? scene.stream.table.num_cells() : scene.stream.table.num_points();
  const Unit* unit = units.first(UnitType::kIndex);
  plan.whole = is_all || unit == nullptr || wants_all(request, options);
  plan.partial = request.missing || request.region ||
                 (options.max_bytes > 0 && options.max_bytes < stream_bytes);
  if (plan.whole) return plan;
  SLF_TRY(const Index index, read_index(*unit, plan.set));
  const std::vector<std::uint8_t> chosen = choose_slices_by_box(request, index.boxes);
  SLF_CHECK(choose_units(index, unit->offset + unit->bytes,
                         {head.size(), stream_bytes - head.size()}, request, chosen,
                         options.max_bytes, plan));
  std::vector<std::uint8_t> present(chosen.size(), false);
  for (const ReadPlan::Wanted& wanted : plan.units)
    if (wanted.entry.type == UnitType::kGeometry && wanted.entry.ids.slice_id < present.size())
      present[wanted.entry.ids.slice_id] = true;
  plan.set = cut_sequence(request, chosen, present);
  return plan;
}

Result<LightField> decode_pieces(std::span<const std::uint8_t> head, const ReadPlan& plan,
                                 std::span<const StreamPiece> pieces,
                                 const DecodeOptions& options) {
  SLF_TRY(Units units, split_units(head, 0, options.limits.max_memory));
  const Unit* lists = units.first(UnitType::kIndex);
  Error disagrees{Errc::kOutOfRange, "index_unit_bytes"};
  if (lists != nullptr) disagrees = in_unit(*lists, disagrees);
  // An index lists what follows it, which is not all there.
  std::erase_if(units.units, [](const Unit& unit) { return unit.type == UnitType::kIndex; });
  for (const ReadPlan::Wanted& wanted : plan.units) {
    SLF_TRY(const Unit unit, take_unit(wanted, pieces, plan.set, disagrees));
    units.units.push_back(unit);
  }
  units.complete = false;
  SLF_TRY(SceneUnits scene, collect_units(units, plan.set));
  return decode_units({std::move(units), std::move(scene)}, options);
}

}  // namespace slf
