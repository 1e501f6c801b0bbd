#include "bitstream/zlib_adapter.h"

#include <zlib.h>

#include <algorithm>

namespace slf {

std::uint32_t crc32(std::span<const std::uint8_t> bytes, std::uint32_t crc) {
  uLong value = crc;
  while (!bytes.empty()) {
    const std::size_t part = std::min<std::size_t>(bytes.size(), 1u << 30);
    value = ::crc32(value, bytes.data(), static_cast<uInt>(part));
    bytes = bytes.subspan(part);
  }
  return static_cast<std::uint32_t>(value);
}

std::vector<std::uint8_t> deflate(std::span<const std::uint8_t> bytes) {
  uLongf size = ::compressBound(static_cast<uLong>(bytes.size()));
  std::vector<std::uint8_t> out(size);
  ::compress2(out.data(), &size, bytes.data(), static_cast<uLong>(bytes.size()), 9);
  out.resize(size);
  return out;
}

Result<std::vector<std::uint8_t>> inflate(std::span<const std::uint8_t> bytes, std::size_t size,
                                          const char* element) {
  std::vector<std::uint8_t> out(size + 1);  // one spare byte shows a stream that holds more
  uLongf out_size = static_cast<uLongf>(out.size());
  uLong in_size = static_cast<uLong>(bytes.size());
  const int status = ::uncompress2(out.data(), &out_size, bytes.data(), &in_size);
  if (status != Z_OK || out_size != size || in_size != bytes.size())
    return Error{Errc::kOutOfRange, element, 0};
  out.resize(size);
  return out;
}

}  // namespace slf
