// SPDX-License-Identifier: Apache-2.0
#include "lightfield/splats/zstd_adapter.h"

#if SLF_WITH_ZSTD
#include <zstd.h>
#endif

namespace slf {

#if SLF_WITH_ZSTD
bool has_zstd() { return true; }

bool unzstd(std::span<const std::uint8_t> frames, std::span<std::uint8_t> to) {
  const std::size_t size = ZSTD_decompress(to.data(), to.size(), frames.data(), frames.size());
  return ZSTD_isError(size) == 0 && size == to.size();
}

std::optional<std::vector<std::uint8_t>> zstd(std::span<const std::uint8_t> bytes) {
  constexpr int kZstdLevel = 19;  // of 1 .. 22; above, memory grows with the file
  std::vector<std::uint8_t> out(ZSTD_compressBound(bytes.size()));
  const std::size_t size =
      ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), kZstdLevel);
  if (ZSTD_isError(size) != 0) return std::nullopt;
  out.resize(size);
  return out;
}
#else
bool has_zstd() { return false; }

bool unzstd(std::span<const std::uint8_t>, std::span<std::uint8_t>) { return false; }

std::optional<std::vector<std::uint8_t>> zstd(std::span<const std::uint8_t>) {
  return std::nullopt;
}
#endif

}  // namespace slf
