// SPDX-License-Identifier: Apache-2.0
// Parts of a stream that is read piece by piece: what decode_part gives is what decode gives with
// the same options, wherever that gives something. The first two bytes are the options.
#include <algorithm>
#include <cstdlib>

#include "slf/part_decoder.h"
#include "tests/fuzz/fuzz.h"

namespace {

slf::DecodeOptions options_of(const std::uint8_t* data) {
  slf::DecodeOptions options;
  options.limits = slf::fuzz::small_limits();
  options.levels = data[0] % 8;
  options.groups = data[1] % 4;
  options.layers = data[0] / 8 % 4;
  if (data[0] & 0x40) options.region = slf::VoxelBox{{0, 0, 0}, {data[1], data[1], 3}};
  if (data[0] & 0x80) options.max_bytes = std::uint64_t{data[1]} * 8;
  return options;
}

bool is_same(const slf::LightField& a, const slf::LightField& b) {
  return a.positions == b.positions && a.components == b.components &&
         a.normals.octahedral == b.normals.octahedral && a.header.coded == b.header.coded;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const auto stream = slf::fuzz::with_sound_crcs({data + 2, size - 2});
  const slf::StreamSource source{
      stream.size(), [&](std::uint64_t offset, std::span<std::uint8_t> to) {
        if (offset > stream.size() || to.size() > stream.size() - offset) std::abort();
        std::copy_n(stream.begin() + static_cast<std::ptrdiff_t>(offset), to.size(), to.begin());
        return true;
      }};
  const slf::DecodeOptions options = options_of(data);
  const auto beginning = slf::read_beginning(source, options.limits);
  if (!beginning || !*beginning) return 0;
  const auto part = slf::decode_part(source, **beginning, options);
  if (part && !*part) return 0;
  const auto whole = slf::decode(stream, options);
  if (part && whole && !is_same(**part, *whole)) std::abort();
  // With max_bytes decode takes a unit that is too long for the end; an index knows better.
  const bool may_refuse = options.max_bytes > 0;
  if (!part && whole && !may_refuse && part.error().code != slf::Errc::kLimitExceeded) std::abort();
  slf::fuzz::accept(part);
  return 0;
}
