// libFuzzer target: any bytes are an error or a light field. CRCs are made right first, so that the
// fuzzer reaches the parsers behind them.
#include <cstdint>
#include <vector>

#include "bitstream/zlib_adapter.h"
#include "slf/decoder.h"

namespace {

/// Walks the units as far as their lengths are sound and writes each CRC anew.
void make_crcs_right(std::vector<std::uint8_t>& stream) {
  std::size_t at = 8;
  while (at + 6 <= stream.size()) {
    std::size_t length = 0, p = at + 1;
    for (int shift = 0; p < stream.size() && shift < 42; shift += 7) {
      length |= std::size_t{stream[p] & 0x7Fu} << shift;
      if (!(stream[p++] & 0x80)) break;
    }
    if (length + 4 > stream.size() - p) return;
    const std::uint32_t crc = slf::crc32(std::span(stream).subspan(at, p + length - at));
    for (std::size_t i = 0; i < 4; ++i)
      stream[p + length + i] = static_cast<std::uint8_t>(crc >> (24 - 8 * i));
    at = p + length + 4;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::uint8_t> stream(data, data + size);
  make_crcs_right(stream);
  slf::DecodeOptions options;
  options.limits.max_points = 1 << 14;
  options.limits.max_output_bytes = 1 << 24;
  (void)slf::decode(stream, options);
  options.levels = 2;
  options.groups = 1;
  (void)slf::decode(stream, options);
  (void)slf::read_info(stream, options.limits);
  return 0;
}
