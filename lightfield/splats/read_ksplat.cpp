// SPDX-License-Identifier: Apache-2.0
// .ksplat (GaussianSplats3D), version 0.1: sections of splats, in buckets whose centres positions
// are given from where they are compressed (level 1: halves; level 2: bytes for harmonics too).
#include <array>
#include <bit>
#include <cmath>

#include "lightfield/splats/gaussian_readers.h"
#include "lightfield/splats/half_float.h"

namespace slf {
namespace {

constexpr std::size_t kMainHeader = 4096, kSectionHeader = 1024;
constexpr std::uint32_t kDefaultRange = 32767;  // of a coordinate of 16 bits
constexpr float kDefaultHarmonic = 1.5f;        // least and most of a byte

float float_of(FileBytes bytes, std::size_t at) {
  return std::bit_cast<float>(word_at(bytes, at, 4));
}

/// What holds for all sections.
struct KsplatHeader {
  std::uint32_t max_sections, splats, level;
  float least_harmonic, most_harmonic;

  std::size_t value_bytes() const { return level == 0 ? 4 : 2; }
  std::size_t harmonic_bytes() const { return level == 0 ? 4 : level == 1 ? 2 : 1; }
  /// Position, size, turn, colour.
  std::size_t fixed_bytes() const { return (3 + 3 + 4) * value_bytes() + 4; }
};

struct KsplatSection {
  std::uint64_t splats, max_splats, bucket_size, buckets, bucket_bytes, full_buckets,
      partial_buckets;
  float block_size;
  std::uint32_t range;
  int degree;
  std::size_t functions;  // beyond degree 0
  std::uint64_t splat_bytes;
  std::size_t at;  // of its data

  std::uint64_t centres() const { return at + 4 * partial_buckets; }
  std::uint64_t first_splat() const { return centres() + bucket_bytes * buckets; }
  std::uint64_t end() const { return first_splat() + splat_bytes * max_splats; }
};

std::optional<KsplatHeader> main_header(FileBytes head, std::uint64_t size) {
  if (head.size() < kMainHeader || head[0] != 0 || head[1] != 1) return std::nullopt;
  KsplatHeader header{word_at(head, 4, 4), word_at(head, 16, 4), word_at(head, 20, 2),
                      float_of(head, 36), float_of(head, 40)};
  if (header.max_sections == 0 || header.max_sections > (size - kMainHeader) / kSectionHeader ||
      header.level > 2)
    return std::nullopt;
  if (header.least_harmonic == 0) header.least_harmonic = -kDefaultHarmonic;
  if (header.most_harmonic == 0) header.most_harmonic = kDefaultHarmonic;
  return header;
}

/// The header of a section, whose numbers fit into the file.
Result<KsplatSection, InputError> section_at(const std::string& name, FileBytes bytes,
                                             const KsplatHeader& header, std::size_t index,
                                             std::size_t data) {
  const FileBytes own = bytes.subspan(kMainHeader + index * kSectionHeader, kSectionHeader);
  KsplatSection s{};
  s.splats = word_at(own, 0, 4);
  s.max_splats = word_at(own, 4, 4);
  s.bucket_size = word_at(own, 8, 4);
  s.buckets = word_at(own, 12, 4);
  s.block_size = float_of(own, 16);
  s.bucket_bytes = word_at(own, 20, 2);
  s.range = word_at(own, 24, 4);
  if (s.range == 0) s.range = kDefaultRange;
  s.full_buckets = word_at(own, 32, 4);
  s.partial_buckets = word_at(own, 36, 4);
  s.degree = static_cast<int>(word_at(own, 40, 2));
  s.at = data;
  const auto invalid = [&](const std::string& cause) {
    return InputError{Errc::kInvalidInput,
                      name + ": ksplat section " + std::to_string(index) + ": " + cause};
  };
  if (s.degree > 3)
    return invalid("harmonics of degree " + std::to_string(s.degree) + ": 0 to 3 are expected");
  s.functions = std::size_t(s.degree + 1) * std::size_t(s.degree + 1) - 1;
  s.splat_bytes = header.fixed_bytes() + 3 * s.functions * header.harmonic_bytes();
  // Every product is of numbers below 2^32 and 2^16.
  if (s.splats > s.max_splats || s.end() > bytes.size())
    return invalid("more splats or buckets than the file holds");
  if (header.level > 0 && s.splats > 0 &&
      (s.bucket_bytes < 12 || s.bucket_size == 0 || s.full_buckets + s.partial_buckets > s.buckets))
    return invalid("buckets that do not hold its splats");
  return s;
}

/// Reads the splats of one section, in order.
class SectionReader {
 public:
  SectionReader(FileBytes bytes, const KsplatHeader& header, const KsplatSection& section)
      : bytes_(bytes), header_(header), section_(section) {}

  /// @param harmonics  of the file's degree; what is beyond the section's stays
  void read(std::size_t p, RawGaussian& raw, std::vector<float>& harmonics) {
    const auto at = static_cast<std::size_t>(section_.first_splat() + section_.splat_bytes * p);
    const std::size_t size = header_.value_bytes();
    for (std::size_t k = 0; k < 3; ++k) {
      raw.position[k] = header_.level == 0 ? float_of(bytes_, at + 4 * k) : 0;
      raw.log_deviations[k] = log_deviation_of(value(at + (3 + k) * size));
    }
    for (std::size_t k = 0; k < 4; ++k) raw.rotation[k] = value(at + (6 + k) * size);
    if (header_.level > 0) place_in_bucket(p, at, raw);
    const std::size_t colour = at + 10 * size;
    for (std::size_t c = 0; c < 3; ++c)
      harmonics[c] = harmonic_of_colour(static_cast<float>(bytes_[colour + c]) / 255);
    raw.logit = logit_of_byte(bytes_[colour + 3]);
    std::size_t from = colour + 4;
    for (std::size_t first = 1, own = 3; first < section_.functions + 1; first += own, own += 2)
      for (std::size_t i = 0; i < 3 * own; ++i, from += header_.harmonic_bytes())
        harmonics[3 * (first + i % own) + i / own] = harmonic(from);  // channel by channel
  }

 private:
  float value(std::size_t at) const {
    return header_.level == 0 ? float_of(bytes_, at)
                              : half_float(static_cast<std::uint16_t>(word_at(bytes_, at, 2)));
  }
  float harmonic(std::size_t at) const {
    if (header_.level < 2) return value(at);
    const float t = static_cast<float>(bytes_[at]) / 255;
    return header_.least_harmonic + t * (header_.most_harmonic - header_.least_harmonic);
  }

  /// Full buckets come first; sizes of the others stand before the centres.
  void place_in_bucket(std::size_t p, std::size_t at, RawGaussian& raw) {
    const std::uint64_t in_full = section_.full_buckets * section_.bucket_size;
    std::uint64_t bucket = p / section_.bucket_size;
    if (p >= in_full) {
      while (partial_ < section_.partial_buckets && p >= in_full + before_ + partial_size())
        before_ += partial_size(), ++partial_;
      bucket = section_.full_buckets + partial_;
    }
    const bool known = bucket < section_.buckets;
    const float scale = section_.block_size / 2 / static_cast<float>(section_.range);
    for (std::size_t k = 0; k < 3; ++k) {
      const float steps =
          static_cast<float>(word_at(bytes_, at + 2 * k, 2)) - static_cast<float>(section_.range);
      raw.position[k] =
          known ? steps * scale +
                      float_of(bytes_, static_cast<std::size_t>(section_.centres() +
                                                                section_.bucket_bytes * bucket) +
                                           4 * k)
                : NAN;
    }
  }
  std::uint64_t partial_size() const {
    return word_at(bytes_, section_.at + 4 * static_cast<std::size_t>(partial_), 4);
  }

  FileBytes bytes_;
  const KsplatHeader& header_;
  const KsplatSection& section_;
  std::uint64_t partial_ = 0, before_ = 0;  // partial buckets passed, and their splats
};

}  // namespace

bool is_ksplat(FileBytes head, std::uint64_t size) {
  return size > kMainHeader && main_header(head, size).has_value();
}

Result<GaussianFile, InputError> read_ksplat(const std::string& name, FileBytes bytes) {
  const auto header = bytes.size() > kMainHeader ? main_header(bytes, bytes.size()) : std::nullopt;
  if (!header) return InputError{Errc::kInvalidInput, name + ": ksplat: no header of version 0.1"};
  std::vector<KsplatSection> sections;
  std::size_t data = kMainHeader + header->max_sections * kSectionHeader, splats = 0;
  int degree = 0;
  for (std::size_t i = 0; i < header->max_sections; ++i) {
    SLF_TRY(const KsplatSection section, section_at(name, bytes, *header, i, data));
    data = static_cast<std::size_t>(section.end());
    splats += static_cast<std::size_t>(section.splats);
    if (section.splats > 0) degree = std::max(degree, section.degree);
    sections.push_back(section);
  }
  GaussianCollector collector(degree, UpAxis::kMinusY, splats);
  std::vector<float> harmonics;
  for (const KsplatSection& section : sections) {
    harmonics.assign(3 * std::size_t(degree + 1) * std::size_t(degree + 1), 0);
    SectionReader reader(bytes, *header, section);
    RawGaussian raw;
    for (std::size_t p = 0; p < section.splats; ++p) {
      reader.read(p, raw, harmonics);
      collector.add(raw, harmonics);
    }
  }
  return std::move(collector).take(name, "ksplat");
}

}  // namespace slf
