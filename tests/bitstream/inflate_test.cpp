// SPDX-License-Identifier: Apache-2.0
// Our own checksum and inflate against zlib's: the same values, the same refusals.
#include "bitstream/inflate.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <random>
#include <vector>

#include "bitstream/crc32.h"

namespace slf::inflate_test {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Noise, text-like repetition, or long runs, as metadata may be.
Bytes random_bytes(std::mt19937& random, std::size_t size) {
  const auto kind = random() % 3;
  Bytes bytes(size);
  for (std::size_t i = 0; i < size; ++i)
    bytes[i] = static_cast<std::uint8_t>(kind == 0 ? random()
                                         : kind == 1 && i > 40 && random() % 8
                                             ? bytes[i - 1 - random() % 40]
                                         : kind == 1 ? 'a' + random() % 26
                                                     : i / 300);
  return bytes;
}

Bytes compressed(const Bytes& bytes, int level, int strategy) {
  z_stream z{};
  EXPECT_EQ(deflateInit2(&z, level, Z_DEFLATED, 15, 8, strategy), Z_OK);
  Bytes out(deflateBound(&z, static_cast<uLong>(bytes.size())));
  z.next_in = const_cast<Bytef*>(bytes.data());
  z.avail_in = static_cast<uInt>(bytes.size());
  z.next_out = out.data();
  z.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(deflate(&z, Z_FINISH), Z_STREAM_END);
  out.resize(z.total_out);
  deflateEnd(&z);
  return out;
}

/// What zlib makes of the stream: exactly `size` bytes from all of it, or nothing.
bool zlib_accepts(const Bytes& stream, std::size_t size, Bytes& out) {
  out.assign(size + 1, 0);
  uLongf out_size = static_cast<uLongf>(out.size());
  uLong in_size = static_cast<uLong>(stream.size());
  const int status = uncompress2(out.data(), &out_size, stream.data(), &in_size);
  out.resize(size);
  return status == Z_OK && out_size == size && in_size == stream.size();
}

TEST(Spec_7_8_Inflate, GivesBackWhatZlibDeflatedAtEveryLevelAndStrategy) {
  std::mt19937 random(1);
  for (const std::size_t size : {0u, 1u, 2u, 63u, 1000u, 40000u, 200000u})
    for (const int level : {0, 1, 6, 9})
      for (const int strategy : {Z_DEFAULT_STRATEGY, Z_HUFFMAN_ONLY, Z_RLE, Z_FIXED}) {
        const Bytes bytes = random_bytes(random, size);
        const Bytes stream = compressed(bytes, level, strategy);
        const auto inflated = inflate(stream, bytes.size(), "element");
        ASSERT_TRUE(inflated) << size << " bytes, level " << level << ", strategy " << strategy;
        EXPECT_EQ(*inflated, bytes);
      }
}

TEST(Spec_7_8_Inflate, RefusesTheSameDamageAsZlib) {
  std::mt19937 random(2);
  std::size_t accepted = 0, refused = 0;
  for (int i = 0; i < 20000; ++i) {
    const Bytes bytes = random_bytes(random, random() % 200);
    Bytes stream = compressed(bytes, static_cast<int>(random() % 10),
                              random() % 2 ? Z_FIXED : Z_DEFAULT_STRATEGY);
    if (i % 4 != 0)
      stream[random() % stream.size()] ^= static_cast<std::uint8_t>(1u << random() % 8);
    // The checksum would hide that a wrong code was accepted.
    Bytes expected;
    const bool accepts = zlib_accepts(stream, bytes.size(), expected);
    const auto inflated = inflate(stream, bytes.size(), "element");
    ASSERT_EQ(bool(inflated), accepts) << "case " << i;
    if (accepts) {
      EXPECT_EQ(*inflated, expected);
    }
    (accepts ? accepted : refused) += 1;
  }
  EXPECT_GT(accepted, 1000u);
  EXPECT_GT(refused, 1000u);
}

/// With the checksum that belongs to it, so that nothing but the codes decides.
TEST(Spec_7_8_Inflate, ReadsBlocksOfRandomBitsAsZlibDoes) {
  std::mt19937 random(3);
  std::size_t accepted = 0;
  for (int i = 0; i < 60000; ++i) {
    Bytes raw(2 + random() % 40);
    for (auto& byte : raw) byte = static_cast<std::uint8_t>(random());
    // One last block, of fixed or of own codes.
    raw[0] = static_cast<std::uint8_t>((raw[0] & ~7u) | (i % 2 ? 3u : 5u));
    z_stream z{};
    ASSERT_EQ(inflateInit2(&z, -15), Z_OK);
    Bytes out(1 << 16);
    z.next_in = raw.data();
    z.avail_in = static_cast<uInt>(raw.size());
    z.next_out = out.data();
    z.avail_out = static_cast<uInt>(out.size());
    const bool ends = ::inflate(&z, Z_FINISH) == Z_STREAM_END;
    const std::size_t used = z.total_in, size = z.total_out;
    inflateEnd(&z);
    Bytes stream = {0x78, 0x9C};
    stream.insert(stream.end(), raw.begin(),
                  raw.begin() + static_cast<std::ptrdiff_t>(ends ? used : raw.size()));
    const auto sum = static_cast<std::uint32_t>(
        adler32(adler32(0, nullptr, 0), out.data(), static_cast<uInt>(size)));
    for (int shift = 24; shift >= 0; shift -= 8)
      stream.push_back(static_cast<std::uint8_t>(sum >> shift));
    const auto inflated = slf::inflate(stream, size, "element");
    ASSERT_EQ(bool(inflated), ends) << "case " << i;
    if (!ends) continue;
    ++accepted;
    EXPECT_TRUE(std::equal(inflated->begin(), inflated->end(), out.begin()));
  }
  EXPECT_GT(accepted, 1000u);
}

TEST(Spec_7_8_Inflate, EveryTruncationAndEveryOtherSizeIsRefused) {
  std::mt19937 random(4);
  const Bytes bytes = random_bytes(random, 500);
  const Bytes stream = compressed(bytes, 9, Z_DEFAULT_STRATEGY);
  for (std::size_t size = 0; size < stream.size(); ++size) {
    const Bytes cut(stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(size));
    const auto inflated = inflate(cut, bytes.size(), "metadata_deflated");
    ASSERT_FALSE(inflated) << size;
    EXPECT_EQ(inflated.error().code, Errc::kOutOfRange);
    EXPECT_STREQ(inflated.error().element, "metadata_deflated");
  }
  for (const std::size_t size : {bytes.size() - 1, bytes.size() + 1})
    EXPECT_FALSE(inflate(stream, size, "element")) << size;
  Bytes longer = stream;
  longer.push_back(0);
  EXPECT_FALSE(inflate(longer, bytes.size(), "element"));
}

TEST(Spec_7_1_Crc32, IsZlibsWhereverTheBytesAreParted) {
  std::mt19937 random(5);
  for (int i = 0; i < 500; ++i) {
    const Bytes bytes = random_bytes(random, random() % 3000);
    const auto expected =
        static_cast<std::uint32_t>(::crc32(0, bytes.data(), static_cast<uInt>(bytes.size())));
    EXPECT_EQ(crc32(bytes), expected);
    const std::size_t part = bytes.empty() ? 0 : random() % bytes.size();
    EXPECT_EQ(crc32(std::span(bytes).subspan(part), crc32(std::span(bytes).first(part))), expected);
  }
}

}  // namespace
}  // namespace slf::inflate_test
