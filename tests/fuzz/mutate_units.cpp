// SPDX-License-Identifier: Apache-2.0
// A mutator for libFuzzer that knows units: it changes the payload of one, repeats, drops, moves,
// cuts or inserts one, and writes lengths, checksums and the count of the end unit anew. Streams of
// frames too: a signature stands before some units. Linked into the targets of streams
// (SLF_FUZZ_UNITS).
#include <algorithm>
#include <cstring>
#include <random>

#include "bitstream/bit_writer.h"
#include "bitstream/units.h"
#include "tests/fuzz/fuzz.h"

#ifndef SLF_FUZZ_LEAD
#define SLF_FUZZ_LEAD 0  // bytes of the target's own before the stream
#endif

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

using Bytes = std::vector<std::uint8_t>;

struct MutableUnit {
  bool signature = false;  // stands before it
  slf::UnitType type{};
  Bytes payload;
};

/// Units up to the first bytes that are none.
std::vector<MutableUnit> units_of(std::span<const std::uint8_t> stream) {
  std::vector<MutableUnit> units;
  std::size_t at = 0;
  while (at < stream.size()) {
    const auto& mark = slf::kSignature;
    const bool signature =
        stream.size() - at >= mark.size() &&
        std::equal(mark.begin(), mark.end(), stream.begin() + std::ptrdiff_t(at));
    if (signature) at += mark.size();
    const auto unit = slf::read_unit(stream, at);
    if (!unit) break;
    units.push_back({signature, unit->type, {unit->payload.begin(), unit->payload.end()}});
    at += static_cast<std::size_t>(unit->bytes);
  }
  return units;
}

Bytes stream_of(std::vector<MutableUnit>& units) {
  Bytes stream;
  std::size_t since_signature = 0;
  for (MutableUnit& unit : units) {
    if (unit.signature) {
      stream.insert(stream.end(), slf::kSignature.begin(), slf::kSignature.end());
      since_signature = 0;
    }
    if (unit.type == slf::UnitType::kFrame && !unit.signature && since_signature > 2)
      since_signature = 0;  // a predicted frame counts its own
    if (unit.type == slf::UnitType::kEnd) {
      slf::BitWriter count;
      count.ue(since_signature);
      unit.payload = count.take();
    }
    slf::append_unit(stream, unit.type, unit.payload);
    ++since_signature;
  }
  return stream;
}

void mutate_payload(Bytes& payload, std::size_t room) {
  const std::size_t size = payload.size();
  payload.resize(size + room);
  payload.resize(LLVMFuzzerMutate(payload.data(), size, size + room));
}

/// One change. room: bytes that the stream may grow by
void mutate(std::vector<MutableUnit>& units, std::minstd_rand& random, std::size_t room) {
  const std::size_t at = random() % units.size(), other = random() % units.size();
  switch (random() % 10) {
    case 0:
      if (units[at].payload.size() < room)
        units.insert(units.begin() + std::ptrdiff_t(other), units[at]);
      break;
    case 1:
      if (units.size() > 1) units.erase(units.begin() + std::ptrdiff_t(at));
      break;
    case 2:
      std::swap(units[at], units[other]);
      break;
    case 3:
      units[at].payload.resize(units[at].payload.size() / 2);
      break;
    case 4:
      units.insert(units.begin() + std::ptrdiff_t(at),
                   {false, static_cast<slf::UnitType>(random() % 18), {}});
      break;
    default:
      mutate_payload(units[at].payload, std::min<std::size_t>(room, 64));
  }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  std::minstd_rand random(seed);
  if (size <= SLF_FUZZ_LEAD || random() % 8 == 0) return LLVMFuzzerMutate(data, size, max_size);
  const auto mended =
      slf::fuzz::with_sound_crcs_of_frames({data + SLF_FUZZ_LEAD, size - SLF_FUZZ_LEAD});
  std::vector<MutableUnit> units = units_of(mended);
  if (units.empty()) return LLVMFuzzerMutate(data, size, max_size);
  for (std::size_t count = 1 + random() % 3; count > 0 && !units.empty(); --count)
    mutate(units, random, max_size > size ? max_size - size : 0);
  const Bytes stream = stream_of(units);
  const std::size_t length = std::min(stream.size(), max_size - SLF_FUZZ_LEAD);
  std::memcpy(data + SLF_FUZZ_LEAD, stream.data(), length);
  return SLF_FUZZ_LEAD + length;
}
