// SPDX-License-Identifier: Apache-2.0
#include "bitstream/inflate.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace slf {
namespace {

constexpr int kMostBits = 15;  // of a code
constexpr std::size_t kLiterals = 288, kEndOfBlock = 256, kMostLengths = 286, kMostDistances = 30;

/// Least significant bit first, unlike the rest of the format. Past the end bits are 0 and ok() is
/// false.
class DeflateBits {
 public:
  explicit DeflateBits(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::uint32_t take(int n) {  // 0 .. 16
    std::uint32_t value = 0;
    for (int i = 0; i < n; ++i) value |= bit() << i;
    return value;
  }
  std::uint32_t bit() {
    ok_ = ok_ && at_ / 8 < bytes_.size();
    if (!ok_) return 0;
    const std::uint32_t value = bytes_[at_ / 8] >> at_ % 8 & 1u;
    ++at_;
    return value;
  }
  /// Whole bytes, from the next boundary on.
  std::span<const std::uint8_t> take_bytes(std::size_t count) {
    const std::size_t begin = (at_ + 7) / 8;
    ok_ = ok_ && count <= bytes_.size() - begin;
    if (!ok_) return {};
    at_ = (begin + count) * 8;
    return bytes_.subspan(begin, count);
  }
  bool at_end() const { return (at_ + 7) / 8 == bytes_.size(); }
  bool ok() const { return ok_; }
  void fail() { ok_ = false; }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;  // bits
  bool ok_ = true;
};

/// A canonical prefix code, RFC 1951 3.2.2: codes of a length follow those of the length before.
class PrefixCode {
 public:
  /// @param lengths  of the codes of all symbols, 0: it has none
  explicit PrefixCode(std::span<const std::uint8_t> lengths) {
    for (const std::uint8_t length : lengths) ++count_[length];
    count_[0] = 0;
    std::array<std::uint16_t, kMostBits + 2> next{};
    for (std::size_t n = 1; n <= kMostBits; ++n) {
      next[n + 1] = static_cast<std::uint16_t>(next[n] + count_[n]);
      left_ = 2 * left_ - count_[n];
      if (left_ < 0) return;
    }
    for (std::size_t s = 0; s < lengths.size(); ++s)
      if (lengths[s] != 0) symbol_[next[lengths[s]]++] = static_cast<std::uint16_t>(s);
  }

  bool is_complete() const { return left_ == 0; }
  /// All codes are there, or there is but one, of one bit; or none.
  bool is_usable() const {
    return left_ == 0 || left_ == 1 << kMostBits ||
           (left_ > 0 && left_ == 1 << (kMostBits - 1) && count_[1] == 1);
  }

  std::size_t decode(DeflateBits& in) const {
    std::uint32_t code = 0, first = 0, index = 0;
    for (std::size_t n = 1; n <= kMostBits; ++n) {
      code |= in.bit();
      if (code < first + count_[n]) return symbol_[index + (code - first)];
      index += count_[n];
      first = (first + count_[n]) << 1;
      code <<= 1;
    }
    in.fail();
    return 0;
  }

 private:
  std::array<std::uint16_t, kMostBits + 1> count_{};  // [length]
  std::array<std::uint16_t, kLiterals> symbol_{};     // by length, then value
  std::int32_t left_ = 1;                             // codes of the greatest length that are free
};

struct BlockCodes {
  PrefixCode literals, distances;
};

BlockCodes fixed_codes() {
  std::array<std::uint8_t, kLiterals> literals;
  for (std::size_t s = 0; s < kLiterals; ++s)
    literals[s] = s < 144 ? 8 : s < 256 ? 9 : s < 280 ? 7 : 8;
  std::array<std::uint8_t, kMostDistances> distances;
  distances.fill(5);
  return {PrefixCode(literals), PrefixCode(distances)};
}

/// RFC 1951 3.2.7: `count` lengths of codes, themselves coded.
void read_lengths(DeflateBits& in, const PrefixCode& code, std::span<std::uint8_t> lengths) {
  for (std::size_t i = 0; i < lengths.size() && in.ok();) {
    const std::size_t symbol = code.decode(in);
    if (symbol < 16) {
      lengths[i++] = static_cast<std::uint8_t>(symbol);
      continue;
    }
    if (symbol == 16 && i == 0) return in.fail();
    const std::uint8_t length = symbol == 16 ? lengths[i - 1] : 0;
    const std::size_t repeat = symbol == 16   ? 3 + in.take(2)
                               : symbol == 17 ? 3 + in.take(3)
                                              : 11 + in.take(7);
    if (repeat > lengths.size() - i) return in.fail();
    std::fill_n(lengths.begin() + static_cast<std::ptrdiff_t>(i), repeat, length);
    i += repeat;
  }
}

BlockCodes read_codes(DeflateBits& in) {
  static constexpr std::array<std::uint8_t, 19> kOrder = {16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                                          11, 4,  12, 3, 13, 2, 14, 1, 15};
  const std::size_t literals = 257 + in.take(5), distances = 1 + in.take(5);
  const std::size_t count = 4 + in.take(4);
  std::array<std::uint8_t, 19> of_lengths{};
  for (std::size_t i = 0; i < count; ++i)
    of_lengths[kOrder[i]] = static_cast<std::uint8_t>(in.take(3));
  const PrefixCode code(of_lengths);
  std::array<std::uint8_t, kLiterals + 32> lengths{};
  if (literals > kMostLengths || distances > kMostDistances || !code.is_complete()) {
    in.fail();
  } else {
    read_lengths(in, code, std::span(lengths).first(literals + distances));
  }
  BlockCodes codes{PrefixCode(std::span(lengths).first(literals)),
                   PrefixCode(std::span(lengths).subspan(literals, distances))};
  const bool usable = codes.literals.is_usable() && codes.distances.is_usable();
  if (lengths[kEndOfBlock] == 0 || !usable) in.fail();
  return codes;
}

/// What inflates into at most `most` bytes.
class Inflater {
 public:
  Inflater(std::span<const std::uint8_t> bytes, std::size_t most) : in_(bytes), most_(most) {}

  /// All blocks. False: damaged, or more than `most`.
  bool run() {
    bool last = false;
    while (in_.ok() && !last) {
      last = in_.bit() != 0;
      const std::uint32_t kind = in_.take(2);
      if (kind == 0) {
        copy_stored();
      } else if (kind == 3) {
        in_.fail();
      } else {
        const BlockCodes codes = kind == 1 ? fixed_codes() : read_codes(in_);
        decode_block(codes);
      }
    }
    return in_.ok() && in_.at_end();
  }

  std::vector<std::uint8_t> take() { return std::move(out_); }

 private:
  bool has_room(std::size_t count) {
    if (count > most_ - out_.size()) in_.fail();
    return in_.ok();
  }

  void copy_stored() {
    const auto header = in_.take_bytes(4);
    if (!in_.ok()) return;
    const std::size_t size = header[0] | std::size_t{header[1]} << 8;
    const std::size_t inverse = header[2] | std::size_t{header[3]} << 8;
    if (size + inverse != 0xFFFF) return in_.fail();
    const auto stored = in_.take_bytes(size);
    if (has_room(stored.size())) out_.insert(out_.end(), stored.begin(), stored.end());
  }

  void decode_block(const BlockCodes& codes) {
    while (in_.ok()) {
      const std::size_t symbol = codes.literals.decode(in_);
      if (symbol == kEndOfBlock) return;
      if (symbol > kEndOfBlock) {
        copy_match(symbol - kEndOfBlock - 1, codes.distances);
      } else if (has_room(1)) {
        out_.push_back(static_cast<std::uint8_t>(symbol));
      }
    }
  }

  /// RFC 1951 3.2.5. Codes of a size come in fours (lengths) and twos (distances), each with as
  /// many extra bits.
  void copy_match(std::size_t code, const PrefixCode& distances) {
    if (code >= 29) return in_.fail();
    const int bits = code < 8 || code == 28 ? 0 : static_cast<int>(code / 4) - 1;
    std::size_t length = code < 8 ? 3 + code : 3 + ((4 + code % 4) << bits);
    length = code == 28 ? 258 : length + in_.take(bits);
    const std::size_t which = distances.decode(in_);
    if (which >= kMostDistances) return in_.fail();
    const int more = which < 4 ? 0 : static_cast<int>(which / 2) - 1;
    const std::size_t distance = 1 + (which < 4 ? which : (2 + which % 2) << more) + in_.take(more);
    if (distance > out_.size()) return in_.fail();
    if (!has_room(length)) return;
    for (; length > 0; --length) out_.push_back(out_[out_.size() - distance]);
  }

  DeflateBits in_;
  std::size_t most_;
  std::vector<std::uint8_t> out_;
};

std::uint32_t adler32(std::span<const std::uint8_t> bytes) {
  std::uint32_t a = 1, b = 0;
  for (const std::uint8_t byte : bytes) {
    a = (a + byte) % 65521;
    b = (b + a) % 65521;
  }
  return b << 16 | a;
}

/// RFC 1950 2.2: method 8, a window of at most 32 kB, no dictionary.
bool is_zlib_header(std::uint32_t method, std::uint32_t flags) {
  return (method & 15) == 8 && method >> 4 <= 7 && (method << 8 | flags) % 31 == 0 &&
         (flags & 0x20) == 0;
}

}  // namespace

Result<std::vector<std::uint8_t>> inflate(std::span<const std::uint8_t> bytes, std::size_t size,
                                          const char* element) {
  const Error damaged{Errc::kOutOfRange, element, 0};
  if (bytes.size() < 6 || !is_zlib_header(bytes[0], bytes[1])) return damaged;
  const auto checksum = bytes.last(4);
  Inflater inflater(bytes.subspan(2, bytes.size() - 6), size);
  if (!inflater.run()) return damaged;
  std::vector<std::uint8_t> out = inflater.take();
  std::uint32_t expected = 0;
  for (const std::uint8_t byte : checksum) expected = expected << 8 | byte;
  if (out.size() != size || adler32(out) != expected) return damaged;
  return out;
}

}  // namespace slf
