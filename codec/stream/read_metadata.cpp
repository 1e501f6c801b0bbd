// SPDX-License-Identifier: Apache-2.0
// Metadata of a stream of which the beginning was read. Spec 7.7, 7.8.
#include <vector>

#include "base/error_place.h"
#include "bitstream/index.h"
#include "bitstream/metadata.h"
#include "codec/scene_units.h"
#include "slf/part_decoder.h"

namespace slf {
namespace {

/// Deflated, metadata are no longer than a reader takes, but for some bytes of headers (7.8).
constexpr std::uint64_t kMostBytes = (std::uint64_t{1} << 20) + 4096;

Result<Metadata> read_at(const StreamSource& source, std::uint64_t offset, std::uint64_t size) {
  const Error disagrees =
      of_unit(UnitType::kMetadata, offset, Errc::kOutOfRange, "index_unit_bytes");
  if (size > kMostBytes || offset > source.bytes || size > source.bytes - offset) return disagrees;
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  if (!source.read(offset, bytes)) return Error{Errc::kUnreadable, "stream", 8 * offset};
  SLF_TRY(const Unit unit, counted_from(8 * offset, read_unit(bytes, 0)));
  if (unit.type != UnitType::kMetadata || unit.bytes != size) return disagrees;
  return in_unit(unit, parse_metadata(unit.payload));
}

}  // namespace

Result<Metadata> read_metadata(const StreamSource& source, const StreamBeginning& beginning,
                               const DecodeLimits& limits) {
  if (!beginning.info.metadata.empty()) return beginning.info.metadata;
  SLF_TRY(const OpenStream opened, open_stream(beginning.bytes, limits));
  const Unit* listed = opened.units.first(UnitType::kIndex);
  if (listed == nullptr) return Metadata{};
  SLF_TRY(const Index index, read_index(*listed, opened.scene.stream.set));
  std::uint64_t offset = listed->offset + listed->bytes;
  for (const IndexEntry& entry : index.entries) {
    if (entry.type == UnitType::kMetadata && offset >= beginning.bytes.size())
      return read_at(source, offset, entry.bytes);
    offset += entry.bytes;
  }
  return Metadata{};
}

}  // namespace slf
