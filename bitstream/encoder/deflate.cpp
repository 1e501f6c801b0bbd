// SPDX-License-Identifier: Apache-2.0
#include "bitstream/encoder/deflate.h"

#include <zlib.h>

#include <algorithm>
#include <cstddef>

namespace slf {

std::vector<std::uint8_t> deflate(std::span<const std::uint8_t> bytes) {
  uLongf size = ::compressBound(static_cast<uLong>(bytes.size()));
  std::vector<std::uint8_t> out(size);
  ::compress2(out.data(), &size, bytes.data(), static_cast<uLong>(bytes.size()), 9);
  out.resize(size);
  return out;
}

std::vector<std::uint8_t> gzip(std::span<const std::uint8_t> bytes) {
  constexpr int kGzip = 16 + MAX_WBITS;
  z_stream stream{};
  std::vector<std::uint8_t> out;
  if (deflateInit2(&stream, 9, Z_DEFLATED, kGzip, 9, Z_DEFAULT_STRATEGY) != Z_OK) return out;
  std::vector<std::uint8_t> block(std::size_t{1} << 18);
  for (int status = Z_OK; status == Z_OK;) {  // else the end, or no memory
    const std::size_t part = std::min<std::size_t>(bytes.size(), 1u << 30);
    stream.next_in = const_cast<Bytef*>(bytes.data());
    stream.avail_in = static_cast<uInt>(part);
    stream.next_out = block.data();
    stream.avail_out = static_cast<uInt>(block.size());
    status = ::deflate(&stream, part == bytes.size() ? Z_FINISH : Z_NO_FLUSH);
    bytes = bytes.subspan(part - stream.avail_in);
    out.insert(out.end(), block.begin(),
               block.end() - static_cast<std::ptrdiff_t>(stream.avail_out));
  }
  deflateEnd(&stream);
  return out;
}

Gunzipped gunzip(std::span<const std::uint8_t> file, std::size_t most) {
  constexpr int kGzip = 16 + MAX_WBITS;
  Gunzipped out;
  z_stream stream{};
  if (inflateInit2(&stream, kGzip) != Z_OK) return out;
  std::vector<std::uint8_t> block(std::min(most, std::size_t{1} << 18));
  for (int status = Z_OK; status == Z_OK && out.bytes.size() < most;) {
    const std::size_t part = std::min<std::size_t>(file.size(), 1u << 30);
    const std::size_t room = std::min(block.size(), most - out.bytes.size());
    stream.next_in = const_cast<Bytef*>(file.data());
    stream.avail_in = static_cast<uInt>(part);
    stream.next_out = block.data();
    stream.avail_out = static_cast<uInt>(room);
    status = ::inflate(&stream, Z_NO_FLUSH);
    file = file.subspan(part - stream.avail_in);
    const std::size_t count = room - stream.avail_out;
    out.bytes.insert(out.bytes.end(), block.begin(),
                     block.begin() + static_cast<std::ptrdiff_t>(count));
    out.whole = status == Z_STREAM_END;
    if (count == 0 && file.empty()) break;  // cut off
  }
  inflateEnd(&stream);
  return out;
}

}  // namespace slf
