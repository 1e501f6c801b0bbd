// SPDX-License-Identifier: Apache-2.0
#include "encoder/plenoptic/corrections.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "base/release.h"
#include "entropy/range_decoder.h"
#include "entropy/range_encoder.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::array<std::uint8_t, 4> kName = {'P', 'L', 'N', '1'};
constexpr std::size_t kChunkPoints = std::size_t{1} << 16;  // a codeword each
constexpr std::uint32_t kMostCount = 255;                   // of counts of contexts
constexpr int kUnary = 14;                                  // magnitudes beyond it follow raw
constexpr int kLargest = 255;

/// Contexts of one codeword. A correction is told by those around it: of the view before, of the
/// channel before, of the point before.
class CorrectionModel {
 public:
  explicit CorrectionModel(std::size_t row) : above_(row, 0) {}

  /// One point; r is coded from, or decoded to, corrections of its bytes.
  template <class Coder>
  void point(Coder& coder, std::span<int> r) {
    for (std::size_t j = 0; j < r.size(); ++j) {
      const int view = j >= 3 ? r[j - 3] : 0, channel = j % 3 != 0 ? r[j - 1] : 0;
      const std::size_t near =
          activity(2 * std::abs(view) + std::abs(channel) + std::abs(above_[j]));
      r[j] = value(coder, near, j % 3, sign_of(view), sign_of(channel), r[j]);
      above_[j] = r[j];
    }
  }

 private:
  static std::size_t activity(int sum) {
    constexpr std::array<std::uint8_t, 17> kClass = {0, 1, 2, 3, 4, 5, 5, 6, 6,
                                                     7, 7, 7, 8, 8, 8, 9, 9};
    return sum < 17 ? kClass[static_cast<std::size_t>(sum)] : sum < 32 ? 10 : 11;
  }
  static std::size_t sign_of(int value) { return value == 0 ? 0 : value > 0 ? 1 : 2; }

  template <class Coder>
  int value(Coder& coder, std::size_t near, std::size_t channel, std::size_t view_sign,
            std::size_t channel_sign, int given) {
    const int size = std::abs(given);
    auto& unary = size_[channel][near];
    int n = 0;
    while (n < kUnary && coder.bit(unary[static_cast<std::size_t>(n)], kMostCount,
                                   static_cast<unsigned>(size > n)))
      ++n;
    if (n == kUnary)
      n += static_cast<int>(coder.raw(8, static_cast<std::uint32_t>(std::max(size - kUnary, 0))));
    if (n == 0) return 0;
    const bool negative = coder.bit(sign_[channel][3 * view_sign + channel_sign], kMostCount,
                                    static_cast<unsigned>(given < 0)) != 0;
    return negative ? -n : n;
  }

  std::array<std::array<std::array<AdaptiveBit, kUnary>, 12>, 3> size_{};
  std::array<std::array<AdaptiveBit, 9>, 3> sign_{};
  std::vector<int> above_;
};

std::size_t chunks_of(std::size_t points) { return (points + kChunkPoints - 1) / kChunkPoints; }

void put_u32(std::vector<std::uint8_t>& out, std::size_t value) {
  for (int shift = 24; shift >= 0; shift -= 8)
    out.push_back(static_cast<std::uint8_t>(value >> shift));
}

std::size_t get_u32(std::span<const std::uint8_t> bytes) {
  std::size_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | bytes[i];
  return value;
}

std::vector<std::uint8_t> code_chunk(const ByteRows& exact, const ByteRows& near, std::size_t first,
                                     std::size_t end) {
  const std::size_t row = exact.row;
  RangeEncoder coder;
  CorrectionModel model(row);
  std::vector<int> r(row);
  for (std::size_t p = first; p < end; ++p) {
    for (std::size_t j = 0; j < row; ++j) r[j] = exact.bytes[p * row + j] - near.bytes[p * row + j];
    model.point(coder, r);
  }
  return coder.finish();
}

Result<Done> decode_chunk(std::span<const std::uint8_t> codeword, std::size_t row,
                          std::span<std::uint8_t> bytes) {
  RangeDecoder coder(codeword);
  CorrectionModel model(row);
  std::vector<int> r(row);
  for (std::size_t at = 0; at < bytes.size(); at += row) {
    model.point(coder, r);
    if (coder.exhausted()) return coder.here(Errc::kTruncated, "plenoptic_corrections");
    for (std::size_t j = 0; j < row; ++j) {
      const int value = bytes[at + j] + r[j];
      if (value < 0 || value > kLargest)
        return coder.here(Errc::kOutOfRange, "plenoptic_corrections");
      bytes[at + j] = static_cast<std::uint8_t>(value);
    }
  }
  return coder.finish("plenoptic_corrections");
}

}  // namespace

std::vector<std::uint8_t> write_corrections(const ByteRows& exact, const ByteRows& near,
                                            int threads) {
  const std::size_t points = exact.bytes.size() / exact.row;
  std::vector<std::vector<std::uint8_t>> codewords(chunks_of(points));
  parallel_ranges(codewords.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      codewords[i] =
          code_chunk(exact, near, i * kChunkPoints, std::min(points, (i + 1) * kChunkPoints));
  });
  std::vector<std::uint8_t> payload(kName.begin(), kName.end());
  put_u32(payload, points);
  put_u32(payload, exact.row);
  for (std::vector<std::uint8_t>& codeword : codewords) {
    put_u32(payload, codeword.size());
    payload.insert(payload.end(), codeword.begin(), codeword.end());
    release(codeword);
  }
  return payload;
}

bool corrects(std::span<const std::uint8_t> payload, std::size_t points) {
  return payload.size() >= 8 && get_u32(payload.subspan(4)) == points;
}

Result<Done> apply_corrections(std::span<const std::uint8_t> payload, std::size_t row,
                               std::span<std::uint8_t> near, int threads) {
  const Error truncated{Errc::kTruncated, "plenoptic_corrections"};
  const std::size_t points = near.size() / row;
  if (payload.size() < 12) return truncated;
  if (!std::equal(kName.begin(), kName.end(), payload.begin()))
    return Error{Errc::kUnsupported, "plenoptic_corrections"};
  if (get_u32(payload.subspan(4)) != points || get_u32(payload.subspan(8)) != row)
    return Error{Errc::kOutOfRange, "plenoptic_corrections"};
  payload = payload.subspan(12);
  std::vector<std::span<const std::uint8_t>> codewords(chunks_of(points));
  for (auto& codeword : codewords) {
    if (payload.size() < 4 || get_u32(payload) > payload.size() - 4) return truncated;
    codeword = payload.subspan(4, get_u32(payload));
    payload = payload.subspan(4 + codeword.size());
  }
  if (!payload.empty()) return Error{Errc::kOutOfRange, "plenoptic_corrections"};
  std::vector<Result<Done>> results(codewords.size(), Done{});
  parallel_ranges(codewords.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t first = i * kChunkPoints * row;
      const std::size_t size = std::min(kChunkPoints * row, near.size() - first);
      results[i] = decode_chunk(codewords[i], row, near.subspan(first, size));
    }
  });
  for (const auto& result : results)
    if (!result) return result.error();
  return Done{};
}

}  // namespace slf
