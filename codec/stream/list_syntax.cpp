// SPDX-License-Identifier: Apache-2.0
// slf info --syntax: the same descriptions that parse the headers, with every element noted.
#include "slf/syntax_listing.h"

#include "attributes/texture/texture_header.h"
#include "base/shortest.h"
#include "bitstream/index.h"
#include "bitstream/transform_header.h"
#include "codec/scene_units.h"
#include "codec/sequence.h"
#include "codec/split_frames.h"

namespace slf {
namespace {

/// Bytes of up to six elements, logged, listed and shown. By measurement.
constexpr std::uint64_t kMemoryOfListedEntry = 1024;

/// Visits what a unit holds before its codeword.
class UnitVisitor {
 public:
  UnitVisitor(BitReader& in, SyntaxLog& log) : in_(in), parse_{in, &log} {}

  Result<Done> visit(const Unit& unit, SequenceParameterSet& set) {
    switch (unit.type) {
      case UnitType::kSequence:
        sequence_parameter_set(parse_, set);
        later_elements(parse_, set);
        break;
      case UnitType::kSlices: {
        SliceTable table;
        slice_table(parse_, table, set.sps_base_levels);
        break;
      }
      case UnitType::kIndex:
        return index(unit, set);
      case UnitType::kTransform: {
        TransformHeader header;
        transform_header(parse_, header, set.num_groups());
        break;
      }
      case UnitType::kFrame: {
        FrameHeader header;
        frame_unit(parse_, header);
        break;
      }
      case UnitType::kMetadata: {
        std::uint64_t bytes = 0;
        parse_.ue("metadata_bytes", bytes, Range{0, 0xFFFFFFFE});
        break;
      }
      case UnitType::kEnd: {
        std::uint64_t units = 0;
        parse_.ue("end_num_units", units, Range{0, 0xFFFFFFFE});
        break;
      }
      default:
        if (has_ids(unit.type)) part(unit, set);
    }
    if (!in_.ok()) return in_.error();
    return Done{};
  }

 private:
  Result<Done> index(const Unit& unit, const SequenceParameterSet& set) {
    SLF_TRY(const Index all, parse_index(unit.payload, set, parse_.log));
    in_.skip_all();
    return Done{};
  }

  void part(const Unit& unit, const SequenceParameterSet& set) {
    SliceUnitHeader header;
    slice_unit_header(parse_, header, unit.type, set);
    if (unit.type != UnitType::kCoefficients || !set.has_texture() || !in_.ok()) return;
    in_.align_and_rest("alignment_zero_bits");
    const auto groups = plane_groups(set);
    std::vector<TexturePlane> planes(3 * groups[header.group].size());
    texture_header(parse_, planes);
  }

  BitReader& in_;
  ParseSyntax parse_;
};

const char* body_name(UnitType type) {
  if (type == UnitType::kSequence) return "sps_extension";
  if (type == UnitType::kMetadata) return "metadata_deflated";
  if (type == UnitType::kDigest) return "digest_sha256";
  return has_ids(type) || type == UnitType::kFrame ? "codeword" : "unit_payload";
}

/// Spec 7.1: of a sequence unit, behind its type.
void add_version(const Units& units, const Unit& sequence, std::vector<ListedElement>& elements) {
  const std::uint64_t bit = 8 * (sequence.offset + 1);
  elements.push_back({"sps_version_major", "u", bit, 8, std::to_string(units.version_major)});
  elements.push_back({"sps_version_minor", "u", bit + 8, 8, std::to_string(units.version_minor)});
}

/// What follows the header as one element: a codeword, deflated metadata, a digest.
void add_body(const Unit& unit, const BitReader& in, std::vector<ListedElement>& elements,
              std::uint64_t payload_bit) {
  const std::uint64_t at = (in.bit_position() + 7) / 8 * 8;
  if (at >= unit.payload.size() * 8) return;
  elements.push_back(
      {body_name(unit.type), "bytes", payload_bit + at, unit.payload.size() * 8 - at, ""});
}

Result<ListedUnit> list_unit(const Units& units, const Unit& unit, SequenceParameterSet& set) {
  const std::uint64_t payload_bit = unit.payload_offset * 8;
  BitReader in(unit.payload);
  SyntaxLog log;
  SLF_CHECK(in_unit(unit, UnitVisitor(in, log).visit(unit, set)));
  ListedUnit listed{unit_name(unit.type), unit.offset, unit.bytes, {}};
  if (unit.type == UnitType::kSequence) add_version(units, unit, listed.elements);
  for (const SyntaxEntry& entry : log)
    listed.elements.push_back(
        {entry.element, entry.kind, payload_bit + entry.bit, entry.bits,
         std::visit([](auto value) { return shortest(value); }, entry.value)});
  add_body(unit, in, listed.elements, payload_bit);
  return listed;
}

}  // namespace

Result<Done> visit_syntax(std::span<const std::uint8_t> stream, const DecodeLimits& limits,
                          const std::function<bool(const ListedUnit&)>& show) {
  if (stream.size() > limits.max_stream_bytes) return Error{Errc::kLimitExceeded, "stream"};
  SLF_TRY(const FrameUnits first, first_frame(stream));
  SLF_TRY(const Units units,
          split_units(stream.first(static_cast<std::size_t>(first.bytes)), 0, limits.max_memory));
  SLF_CHECK(find_sequence(units));  // the unit that all others need
  SequenceParameterSet set;
  for (const Unit& unit : units.units) {
    if (listed_units(unit) > limits.max_memory / kMemoryOfListedEntry)
      return Error{Errc::kLimitExceeded, "max_memory"};
    SLF_TRY(const ListedUnit listed, list_unit(units, unit, set));
    if (!show(listed)) break;
  }
  return Done{};
}

Result<std::vector<ListedUnit>> list_syntax(std::span<const std::uint8_t> stream,
                                            const DecodeLimits& limits) {
  std::vector<ListedUnit> listed;
  SLF_CHECK(visit_syntax(stream, limits, [&](const ListedUnit& unit) {
    listed.push_back(unit);
    return true;
  }));
  return listed;
}

}  // namespace slf
