#include "bitstream/index.h"

#include "bitstream/syntax.h"

namespace slf {
namespace {

// Spec 7.7  index_entry( )
template <class V, class Type, class Bytes>
void index_entry(V& v, Type& type, Bytes& bytes) {
  v.u(8, "index_unit_type", type, Range{0, 255});
  v.ue("index_unit_bytes", bytes, Range{6, 0xFFFFFFFE});
}

}  // namespace

Result<std::vector<IndexEntry>> parse_index(std::span<const std::uint8_t> payload) {
  BitReader in(payload);
  ParseSyntax parse{in};
  std::uint32_t count = 0;
  std::vector<IndexEntry> entries;
  parse.ue("index_num_units", count, Range{0, 0xFFFFFFFE});
  constexpr std::uint64_t kLeastEntryBits = 8 + 5;  // the shortest unit is 6 bytes: ue(6)
  parse.require(count <= in.bits_left() / kLeastEntryBits, Errc::kTruncated, "index_num_units");
  parse.resize("index_num_units", entries, count);
  for (IndexEntry& entry : entries) index_entry(parse, entry.type, entry.bytes);
  in.trailing_bits("index_trailing_bits");
  if (!in.ok()) return in.error();
  return entries;
}

std::vector<std::uint8_t> write_index(const std::vector<IndexEntry>& entries) {
  BitWriter out;
  WriteSyntax write{out};
  write.ue("index_num_units", entries.size(), Range{});
  for (const IndexEntry& entry : entries) index_entry(write, entry.type, entry.bytes);
  return out.take();
}

Result<Done> check_index(const Units& units) {
  for (std::size_t at = 0; at < units.units.size(); ++at) {
    if (units.units[at].type != UnitType::kIndex) continue;
    SLF_TRY(const auto entries, parse_index(units.units[at].payload));
    const std::size_t present = units.units.size() - at - 1;
    const Error wrong{Errc::kOutOfRange, "index_unit_bytes", units.units[at].offset * 8};
    if (present > entries.size() || (units.complete && present < entries.size())) return wrong;
    for (std::size_t i = 0; i < present; ++i) {
      const Unit& unit = units.units[at + 1 + i];
      if (unit.type != entries[i].type || unit.bytes != entries[i].bytes) return wrong;
    }
  }
  return Done{};
}

}  // namespace slf
