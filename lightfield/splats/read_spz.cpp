// SPDX-License-Identifier: Apache-2.0
// SPZ (Niantic): attribute by attribute, versions 1 to 3 in gzip, version 4 each in zstd. Version 1
// has half floats for positions, from version 3 on quaternions lack their largest component.
#include <array>
#include <bit>
#include <cmath>

#include "bitstream/deflate.h"
#include "lightfield/splats/gaussian_readers.h"
#include "lightfield/splats/half_float.h"
#include "lightfield/splats/zstd_adapter.h"

namespace slf {
namespace {

constexpr std::uint32_t kSpzMagic = 0x5053474e;  // "NGSP"
constexpr std::size_t kSpzHeader = 16;
constexpr float kSpzColourScale = 0.15f;  // byte = 255 * (0.5 + 0.15 dc)

/// The header of 16 bytes.
struct SpzHeader {
  std::uint32_t version, splats;
  int degree, fraction_bits;

  std::size_t harmonics() const {  // bytes a splat
    return 3 * (std::size_t(degree + 1) * std::size_t(degree + 1) - 1);
  }
  std::size_t position_bytes() const { return version == 1 ? 6 : 9; }
  std::size_t rotation_bytes() const { return version >= 3 ? 4 : 3; }
  std::size_t splat_bytes() const {  // with opacity, colour and size
    return position_bytes() + 1 + 3 + 3 + rotation_bytes() + harmonics();
  }
};

/// Where the attributes of a file begin: each of all splats.
struct SpzPlaces {
  std::size_t positions, opacities, colours, sizes, rotations, harmonics;
};

SpzPlaces places_of(const SpzHeader& header) {
  SpzPlaces at{};
  const std::size_t count = header.splats;
  at.positions = kSpzHeader;
  at.opacities = at.positions + header.position_bytes() * count;
  at.colours = at.opacities + count;
  at.sizes = at.colours + 3 * count;
  at.rotations = at.sizes + 3 * count;
  at.harmonics = at.rotations + header.rotation_bytes() * count;
  return at;
}

/// 24 bits with a sign.
float fixed_point(FileBytes raw, std::size_t at, int fraction_bits) {
  const auto value = static_cast<std::int32_t>(word_at(raw, at, 3) << 8) >> 8;
  return std::ldexp(static_cast<float>(value), -fraction_bits);
}

/// x, y, z in a byte each; w is what is left, 0 or more.
std::array<float, 4> first_three(FileBytes raw, std::size_t at) {
  std::array<float, 4> q{};
  float square = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    q[k + 1] = static_cast<float>(raw[at + k]) / 127.5f - 1;
    square += q[k + 1] * q[k + 1];
  }
  q[0] = std::sqrt(std::max(0.0f, 1 - square));
  return q;
}

/// Two bits say which of x, y, z, w is the largest, the others have a sign and nine bits of
/// sqrt(1/2) each.
std::array<float, 4> smallest_three(FileBytes raw, std::size_t at) {
  std::uint32_t word = word_at(raw, at, 4);
  const std::size_t largest = word >> 30;
  std::array<float, 4> xyzw{};
  float square = 0;
  for (std::size_t k = 4; k-- > 0;) {
    if (k == largest) continue;
    const float size = static_cast<float>(word & 511) / 511 * std::sqrt(0.5f);
    xyzw[k] = (word >> 9 & 1) != 0 ? -size : size;
    square += xyzw[k] * xyzw[k];
    word >>= 10;
  }
  xyzw[largest] = std::sqrt(std::max(0.0f, 1 - square));
  return {xyzw[3], xyzw[0], xyzw[1], xyzw[2]};
}

/// A splat but for its harmonics beyond degree 0.
RawGaussian splat_at(const SpzHeader& header, const SpzPlaces& places, FileBytes raw, std::size_t p,
                     std::vector<float>& harmonics) {
  RawGaussian out;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t value = 3 * p + k;
    out.position[k] =
        header.version == 1
            ? half_float(static_cast<std::uint16_t>(word_at(raw, places.positions + 2 * value, 2)))
            : fixed_point(raw, places.positions + 3 * value, header.fraction_bits);
    out.log_deviations[k] = static_cast<float>(raw[places.sizes + value]) / 16 - 10;
    harmonics[k] = (static_cast<float>(raw[places.colours + value]) / 255 - 0.5f) / kSpzColourScale;
  }
  out.rotation = header.version >= 3 ? smallest_three(raw, places.rotations + 4 * p)
                                     : first_three(raw, places.rotations + 3 * p);
  out.logit = logit_of_byte(raw[places.opacities + p]);
  return out;
}

/// @errors kInvalidInput, kUnsupported: another version
Result<SpzHeader, InputError> parse_spz_header(const std::string& name, FileBytes raw) {
  const auto fail = [&](Errc code, const std::string& cause) {
    return InputError{code, name + ": SPZ: " + cause};
  };
  if (raw.size() < kSpzHeader || word_at(raw, 0, 4) != kSpzMagic)
    return fail(Errc::kInvalidInput, "damaged or cut off within the header");
  const SpzHeader header{word_at(raw, 4, 4), word_at(raw, 8, 4), raw[12], raw[13]};
  if (header.version < 1 || header.version > 4)
    return fail(Errc::kUnsupported,
                "version " + std::to_string(header.version) + " is not read, 1 to 4 are");
  if (header.degree > 4)
    return fail(Errc::kInvalidInput,
                "harmonics of degree " + std::to_string(header.degree) + ": 0 to 4 are expected");
  if (header.fraction_bits > 24)
    return fail(Errc::kInvalidInput,
                std::to_string(header.fraction_bits) + " fraction bits: 0 to 24 are expected");
  return header;
}

InputError short_of(const std::string& name, const SpzHeader& header) {
  return {Errc::kInvalidInput, name + ": SPZ: damaged, or fewer bytes than its " +
                                   std::to_string(header.splats) + " splats take"};
}

/// Attributes of a file in gzip, behind their header.
Result<std::vector<std::uint8_t>, InputError> gunzipped(const std::string& name,
                                                        const SpzHeader& header, FileBytes file) {
  const std::size_t whole = kSpzHeader + header.splats * header.splat_bytes();
  // One byte more: then the checksum has been looked at.
  Gunzipped raw = gunzip(file, whole + 1);
  if (raw.bytes.size() < whole || (raw.bytes.size() == whole && !raw.whole))
    return short_of(name, header);
  return std::move(raw.bytes);
}

/// The same of version 4: a list of the bytes that each attribute takes, packed and not; then
/// these.
Result<std::vector<std::uint8_t>, InputError> unpacked_streams(const std::string& name,
                                                               const SpzHeader& header,
                                                               FileBytes file) {
  constexpr std::size_t kLongHeader = 32, kEntry = 16;
  const auto fail = [&](const std::string& cause) {
    return InputError{Errc::kInvalidInput, name + ": SPZ 4: " + cause};
  };
  if (file.size() < kLongHeader) return fail("cut off within the header");
  std::vector<std::size_t> sizes;  // of attributes, unpacked
  for (const std::size_t bytes : {header.position_bytes(), std::size_t{1}, std::size_t{3},
                                  std::size_t{3}, header.rotation_bytes(), header.harmonics()})
    if (bytes > 0) sizes.push_back(bytes * header.splats);
  const std::size_t list = word_at(file, 16, 4);
  if (file[15] != sizes.size()) return fail(std::to_string(file[15]) + " attributes");
  if (list < kLongHeader || list > file.size() || file.size() - list < kEntry * sizes.size())
    return fail("the list of attributes is cut off");
  std::vector<std::uint8_t> raw(kSpzHeader + header.splats * header.splat_bytes());
  std::size_t from = list + kEntry * sizes.size(), to = kSpzHeader;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const std::size_t at = list + kEntry * i;
    const std::uint64_t packed = word_at(file, at, 4) | std::uint64_t{word_at(file, at + 4, 4)}
                                                            << 32;
    const std::uint64_t said = word_at(file, at + 8, 4) | std::uint64_t{word_at(file, at + 12, 4)}
                                                              << 32;
    if (said != sizes[i]) return fail("attribute " + std::to_string(i) + " is of another size");
    if (packed > file.size() - from) return fail("attribute " + std::to_string(i) + " is cut off");
    const auto part = static_cast<std::size_t>(packed);
    if (!unzstd(file.subspan(from, part), std::span(raw).subspan(to, sizes[i])))
      return fail("attribute " + std::to_string(i) + " is damaged");
    from += part;
    to += sizes[i];
  }
  if (from != file.size()) return fail("bytes behind the last attribute");
  return raw;
}

}  // namespace

bool is_spz(FileBytes head) {
  if (head.size() >= 4 && word_at(head, 0, 4) == kSpzMagic) return true;
  if (head.size() < 4 || head[0] != 0x1f || head[1] != 0x8b) return false;
  const Gunzipped start = gunzip(head, 4);
  return start.bytes.size() == 4 && word_at(start.bytes, 0, 4) == kSpzMagic;
}

Result<GaussianFile, InputError> read_spz(const std::string& name, FileBytes bytes) {
  const bool plain = word_at(bytes, 0, 4) == kSpzMagic;  // a header outside of what is packed
  if (plain && !has_zstd())
    return InputError{
        Errc::kUnsupported,
        name +
            ": SPZ 4 is in zstd, which this build does not read: splat-transform (npm "
            "@playcanvas/splat-transform) makes a PLY of it"};
  const Gunzipped packed = plain ? Gunzipped{} : gunzip(bytes, kSpzHeader);
  SLF_TRY(const SpzHeader header, parse_spz_header(name, plain ? bytes : FileBytes(packed.bytes)));
  if (plain != (header.version == 4))
    return InputError{
        Errc::kInvalidInput,
        name + ": SPZ: version " + std::to_string(header.version) + " packed as another is"};
  const std::uint64_t whole = kSpzHeader + std::uint64_t{header.splats} * header.splat_bytes();
  if (whole / kMostDeflateRatio > bytes.size()) return short_of(name, header);
  SLF_TRY(const auto raw,
          plain ? unpacked_streams(name, header, bytes) : gunzipped(name, header, bytes));
  const SpzPlaces places = places_of(header);
  GaussianCollector collector(header.degree, UpAxis::kPlusY, header.splats);
  const std::size_t rest = header.harmonics();
  std::vector<float> harmonics(rest + 3);
  for (std::size_t p = 0; p < header.splats; ++p) {
    const RawGaussian splat = splat_at(header, places, raw, p, harmonics);
    for (std::size_t i = 0; i < rest; ++i)
      harmonics[3 + i] = (static_cast<float>(raw[places.harmonics + p * rest + i]) - 128) / 128;
    collector.add(splat, harmonics);
  }
  return std::move(collector).take(name, "SPZ " + std::to_string(header.version));
}

}  // namespace slf
